// The beams of the seven proximity sensors, as long as the measured range, with a dot at the end. Stronger is nearer;
// the sensor panel shows the numbers.

import * as THREE from "three";

import { PROXIMITY } from "../state/names.js";
import { Instances, placeOf } from "./instances.js";
import { overlayMaterial } from "./materials.js";
import { PROXIMITY_PLACES } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

export const MAX_RANGE_M = 0.14;
const SHORTEST_M = 0.002;
const HALF_ANGLE = 0.15; // rad, field of view 0.3 (docs/spec/ros-interface.md section 3)
const OPACITY = { near: 0.85, far: 0.45, empty: 0.15 };
/** What the robot notices is orange. */
export const SENSED = new THREE.Color(0xef7d2e);

/** @param {import("./robot_instances.js").Capacity} room */
export function createRays({ robots, fine }) {
  const counts = { each: PROXIMITY.length, robots };
  const beams = new Instances(fan(), overlayMaterial({ vertexColors: true, color: SENSED }), counts);
  const ball = new THREE.SphereGeometry(0.0032, fine ? 8 : 4, fine ? 5 : 2);
  const dots = new Instances(ball, new THREE.MeshBasicMaterial({ color: SENSED }), counts);
  beams.mesh.renderOrder = 4;
  const mounts = PROXIMITY.map((name) => placeOf(PROXIMITY_PLACES[name], { angle: PROXIMITY_PLACES[name].yaw }));
  const opacity = new THREE.Color();
  return {
    parts: [beams, dots],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot, sensing }) {
      PROXIMITY.forEach((name, index) => {
        const range = robot.proximity[name];
        const seen = Number.isFinite(range) || range === -Infinity;
        const shown = sensing && range !== undefined;
        const length = seen ? Math.max(range, SHORTEST_M) : MAX_RANGE_M;
        const end = new THREE.Matrix4().makeTranslation(length, 0, 0).premultiply(mounts[index]);
        const strength = OPACITY.near + (OPACITY.far - OPACITY.near) * (length / MAX_RANGE_M);
        beams.put(slot, index, shown ? mounts[index].clone().scale(new THREE.Vector3(length, length, 1)) : null);
        beams.tint(slot, index, opacity.setScalar(seen ? strength : OPACITY.empty));
        dots.put(slot, index, shown && seen ? end : null);
      });
    },
  };
}

/** A flat fan of length 1 along x, paler towards its end; scaled, it is the beam. */
function fan() {
  const width = Math.tan(HALF_ANGLE);
  const foot = 0.02;
  const corners = [0, -foot, 0, 1, -width, 0, 1, width, 0, 0, -foot, 0, 1, width, 0, 0, foot, 0];
  const opacities = [1, 0.5, 0.5, 1, 0.5, 1].flatMap((value) => [value, value, value]);
  return new THREE.BufferGeometry()
    .setAttribute("position", new THREE.Float32BufferAttribute(corners, 3))
    .setAttribute("color", new THREE.Float32BufferAttribute(opacities, 3));
}
