// The hit targets of the five buttons: larger than the buttons, and invisible (body.js draws them).

import * as THREE from "three";

import { BUTTON_PLACES } from "./parts.js";

const TOUCH_RADIUS_M = 0.0078;
const RAISED_M = 0.0014;

/** The hit targets, in the robot's frame. @param {string} robot */
export function createTargets(robot) {
  const geometry = new THREE.CircleGeometry(TOUCH_RADIUS_M, 16);
  const material = new THREE.MeshBasicMaterial({ visible: false });
  const meshes = Object.entries(BUTTON_PLACES).map(([button, { x, y, z }]) => {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(x, y, z + RAISED_M);
    mesh.userData = { robot, button };
    return mesh;
  });
  return {
    meshes,
    dispose() {
      geometry.dispose();
      material.dispose();
    },
  };
}
