// The two ground sensors: a ring on the floor under each, filled with the grey it sees, drawn through
// the body because the nose would hide it.

import * as THREE from "three";

import { GROUND } from "../state/names.js";
import { GROUND_PLACES } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

const FULL = 1023;

export function createGroundPatches() {
  const disc = new THREE.CircleGeometry(0.0062, 20);
  const ring = new THREE.RingGeometry(0.0062, 0.0078, 20);
  const edge = new THREE.MeshBasicMaterial({ color: 0x1769d1, depthTest: false, transparent: true });
  const group = new THREE.Group();
  const patches = GROUND.map((name) => {
    const material = new THREE.MeshBasicMaterial({ depthTest: false, transparent: true });
    const fill = new THREE.Mesh(disc, material);
    const rim = new THREE.Mesh(ring, edge);
    for (const mesh of [fill, rim]) {
      mesh.position.set(GROUND_PLACES[name].x, GROUND_PLACES[name].y, 0.001);
      mesh.renderOrder = 3;
      group.add(mesh);
    }
    return { fill, rim, material };
  });
  return {
    group,
    /** @param {Robot} robot */
    update(robot) {
      const deltas = (robot.raw.ground ?? []).slice(4, 6);
      patches.forEach(({ fill, rim, material }, side) => {
        fill.visible = rim.visible = deltas[side] !== undefined;
        const grey = Math.min(1, Math.max(0, (deltas[side] ?? 0) / FULL));
        material.color.setRGB(grey, grey, grey, THREE.SRGBColorSpace);
      });
    },
    dispose: () => [disc, ring, edge, ...patches.map(({ material }) => material)].forEach((thing) => thing.dispose()),
  };
}
