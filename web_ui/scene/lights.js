// The light of every picture of a world.

import * as THREE from "three";

export const SKY = 0xdfecf6;

/** A scene with its lights and sky, and nothing in it. */
export function litScene() {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(SKY);
  const sun = new THREE.DirectionalLight(0xffffff, 1.75);
  sun.position.set(-1.2, -1.6, 3);
  const fill = new THREE.DirectionalLight(0xffffff, 0.5); // so that faces turned away from the sun are not dull
  fill.position.set(1, 1.4, 0.35);
  scene.add(new THREE.HemisphereLight(0xffffff, 0xccd5de, 1.75), sun, fill);
  return scene;
}
