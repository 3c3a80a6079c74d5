// The two ground sensors: a patch on the floor below each, filled with the measured gray, long enough to
// be visible in front of the robot.

import * as THREE from "three";

import { GROUND } from "../state/names.js";
import { Instances, placeOf } from "./instances.js";
import { GROUND_PLACES } from "./parts.js";
import { SENSED } from "./rays.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const FULL = 1023;
const LENGTH_M = 0.026;
const WIDTH_M = 0.011;
const RIM_M = 0.0014;
const AHEAD_M = 0.006;
const HEIGHT_M = 0.003; // above every layer of paint

/** @param {import("./robot_instances.js").Capacity} room */
export function createGroundPatches({ robots }) {
  const sides = GROUND.length;
  const sheet = new THREE.PlaneGeometry(1, 1);
  const patches = new Instances(sheet, new THREE.MeshBasicMaterial(), { each: 2 * sides, robots });
  /** @param {number} z @param {number} rim */
  const places = (z, rim) =>
    GROUND.map((name) => {
      const { x, y } = GROUND_PLACES[name];
      return placeOf({ x: x + AHEAD_M, y, z }).scale(new THREE.Vector3(LENGTH_M + 2 * rim, WIDTH_M + 2 * rim, 1));
    });
  const [rims, fills] = [places(HEIGHT_M, RIM_M), places(HEIGHT_M + 0.0004, 0)];
  const color = new THREE.Color();
  return {
    parts: [patches],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot, sensing }) {
      const deltas = (robot.raw.ground ?? []).slice(4, 6);
      GROUND.forEach((_, side) => {
        const shown = sensing && deltas[side] !== undefined;
        const gray = Math.min(1, Math.max(0, (deltas[side] ?? 0) / FULL));
        patches.put(slot, side, shown ? rims[side] : null);
        patches.tint(slot, side, SENSED);
        patches.put(slot, sides + side, shown ? fills[side] : null);
        patches.tint(slot, sides + side, color.setRGB(gray, gray, gray));
      });
    },
  };
}
