// The lighting of every world.

import * as THREE from "three";

export const SKY = 0xdfecf6;

/** An empty scene with lights and sky. */
export function litScene() {
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(SKY);
  const sun = new THREE.DirectionalLight(0xffffff, 1.75);
  sun.position.set(-1.2, -1.6, 3);
  const fill = new THREE.DirectionalLight(0xffffff, 0.5); // lightens faces turned away from the sun
  fill.position.set(1, 1.4, 0.35);
  scene.add(new THREE.HemisphereLight(0xffffff, 0xccd5de, 1.75), sun, fill);
  return scene;
}
