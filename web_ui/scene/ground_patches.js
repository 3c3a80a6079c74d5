// The two ground sensors: a patch on the floor below each, filled with the grey it sees, long enough to
// look out from under the nose.

import * as THREE from "three";

import { GROUND } from "../state/names.js";
import { GROUND_PLACES } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

const FULL = 1023;
const LENGTH_M = 0.026;
const WIDTH_M = 0.011;
const RIM_M = 0.0014;
const AHEAD_M = 0.006;
const HEIGHT_M = 0.003; // above every layer of paint

export function createGroundPatches() {
  const inner = new THREE.PlaneGeometry(LENGTH_M, WIDTH_M);
  const outer = new THREE.PlaneGeometry(LENGTH_M + 2 * RIM_M, WIDTH_M + 2 * RIM_M);
  const edge = new THREE.MeshBasicMaterial({ color: 0x1769d1 });
  const group = new THREE.Group();
  const patches = GROUND.map((name) => {
    const material = new THREE.MeshBasicMaterial();
    const fill = new THREE.Mesh(inner, material);
    const rim = new THREE.Mesh(outer, edge);
    const { x, y } = GROUND_PLACES[name];
    rim.position.set(x + AHEAD_M, y, HEIGHT_M);
    fill.position.set(x + AHEAD_M, y, HEIGHT_M + 0.0004);
    group.add(rim, fill);
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
    dispose: () => [inner, outer, edge, ...patches.map(({ material }) => material)].forEach((thing) => thing.dispose()),
  };
}
