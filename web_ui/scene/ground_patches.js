// The two ground sensors: a patch on the floor below each, filled with the measured gray, long enough to
// be visible in front of the robot.

import * as THREE from "three";

import { GROUND } from "../state/names.js";
import { Instances, placeOf } from "./instances.js";
import { GROUND_PLACES } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const FULL = 1023;
const LENGTH_M = 0.026;
const WIDTH_M = 0.011;
const RIM_M = 0.0014;
const AHEAD_M = 0.006;
const HEIGHT_M = 0.003; // above every layer of paint
const EDGE = 0x1769d1;

/** @param {import("./robot_instances.js").Capacity} room */
export function createGroundPatches({ robots }) {
  const counts = { each: GROUND.length, robots };
  const outer = new THREE.PlaneGeometry(LENGTH_M + 2 * RIM_M, WIDTH_M + 2 * RIM_M);
  const rims = new Instances(outer, new THREE.MeshBasicMaterial({ color: EDGE }), counts);
  const fills = new Instances(new THREE.PlaneGeometry(LENGTH_M, WIDTH_M), new THREE.MeshBasicMaterial(), counts);
  /** @param {number} z */
  const places = (z) => GROUND.map((name) => placeOf({ x: GROUND_PLACES[name].x + AHEAD_M, y: GROUND_PLACES[name].y, z }));
  const [below, above] = [places(HEIGHT_M), places(HEIGHT_M + 0.0004)];
  const color = new THREE.Color();
  return {
    parts: [rims, fills],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot, sensing }) {
      const deltas = (robot.raw.ground ?? []).slice(4, 6);
      GROUND.forEach((_, side) => {
        const shown = sensing && deltas[side] !== undefined;
        const gray = Math.min(1, Math.max(0, (deltas[side] ?? 0) / FULL));
        rims.put(slot, side, shown ? below[side] : null);
        fills.put(slot, side, shown ? above[side] : null);
        fills.tint(slot, side, color.setRGB(gray, gray, gray, THREE.SRGBColorSpace));
      });
    },
  };
}
