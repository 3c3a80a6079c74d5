// The beams of the seven proximity sensors, as long as the measured range, with a dot at the end.
// Pale blue is far or nothing, red is near; the sensor panel shows the numbers.

import * as THREE from "three";

import { PROXIMITY } from "../state/names.js";
import { Instances, placeOf } from "./instances.js";
import { PROXIMITY_PLACES } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

export const MAX_RANGE_M = 0.14;
const SHORTEST_M = 0.002;
const HALF_ANGLE = 0.15; // rad, field of view 0.3 (docs/spec/ros-interface.md section 3)
const OPACITY = { seen: 0.4, empty: 0.13 };
const FAR = new THREE.Color(0x3b82d0);
const MIDDLE = new THREE.Color(0xf0a202);
const NEAR = new THREE.Color(0xe02d1b);

/** @param {import("./robot_instances.js").Capacity} room */
export function createRays({ robots, fine }) {
  const counts = { each: PROXIMITY.length, robots };
  const beams = new Instances(fan(), beam(OPACITY.seen), counts);
  const empties = new Instances(fan(), beam(OPACITY.empty), counts);
  const dots = new Instances(new THREE.SphereGeometry(0.0032, fine ? 8 : 4, fine ? 5 : 2), new THREE.MeshBasicMaterial(), counts);
  const mounts = PROXIMITY.map((name) => placeOf(PROXIMITY_PLACES[name], { angle: PROXIMITY_PLACES[name].yaw }));
  const color = new THREE.Color();
  return {
    parts: [beams, empties, dots],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot, sensing }) {
      PROXIMITY.forEach((name, index) => {
        const range = robot.proximity[name];
        const seen = Number.isFinite(range) || range === -Infinity;
        const shown = sensing && range !== undefined;
        const length = seen ? Math.max(range, SHORTEST_M) : MAX_RANGE_M;
        const fitted = shown ? mounts[index].clone().scale(new THREE.Vector3(length, length, 1)) : null;
        const end = new THREE.Matrix4().makeTranslation(length, 0, 0).premultiply(mounts[index]);
        colorOf(seen ? length / MAX_RANGE_M : 1, color);
        beams.put(slot, index, seen ? fitted : null);
        empties.put(slot, index, seen ? null : fitted);
        dots.put(slot, index, shown && seen ? end : null);
        for (const part of [beams, empties, dots]) part.tint(slot, index, color);
      });
    },
  };
}

/** @param {number} opacity */
function beam(opacity) {
  const flat = { side: THREE.DoubleSide, forceSinglePass: true };
  return new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false, opacity, ...flat });
}

/** A flat fan of length 1 along x; scaled, it is the beam. */
function fan() {
  const width = Math.tan(HALF_ANGLE);
  const corners = [0, -0.01, 0, 1, -width, 0, 1, width, 0, 0, -0.01, 0, 1, width, 0, 0, 0.01, 0];
  return new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
}

/** @param {number} share  share of the maximum range @param {THREE.Color} target */
function colorOf(share, target) {
  if (share < 0.5) target.copy(NEAR).lerp(MIDDLE, share * 2);
  else target.copy(MIDDLE).lerp(FAR, share * 2 - 1);
}
