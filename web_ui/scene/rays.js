// What the seven proximity sensors see: a beam each, as long as the range, with a dot where it ends.
// Far or nothing is pale blue, near is red; the sensor panel has the numbers.

import * as THREE from "three";

import { PROXIMITY } from "../state/names.js";
import { PROXIMITY_PLACES } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

export const MAX_RANGE_M = 0.14;
const HALF_ANGLE = 0.15; // rad, field of view 0.3 (ros-interface.md section 3)
const FAR = new THREE.Color(0x3b82d0);
const MIDDLE = new THREE.Color(0xf0a202);
const NEAR = new THREE.Color(0xe02d1b);

export function createRays() {
  // A flat fan of length 1 along x: scaled, it is the beam.
  const fan = new THREE.BufferGeometry();
  const width = Math.tan(HALF_ANGLE);
  fan.setAttribute(
    "position",
    new THREE.Float32BufferAttribute([0, -0.01, 0, 1, -width, 0, 1, width, 0, 0, -0.01, 0, 1, width, 0, 0, 0.01, 0], 3),
  );
  const dot = new THREE.SphereGeometry(0.0032, 8, 5);
  const group = new THREE.Group();
  const rays = PROXIMITY.map((name) => {
    const { x, y, z, yaw } = PROXIMITY_PLACES[name];
    const beam = new THREE.Mesh(
      fan,
      new THREE.MeshBasicMaterial({ transparent: true, depthWrite: false, side: THREE.DoubleSide }),
    );
    const hit = new THREE.Mesh(dot, new THREE.MeshBasicMaterial());
    const mount = new THREE.Group();
    mount.position.set(x, y, z);
    mount.rotation.z = yaw;
    mount.add(beam, hit);
    group.add(mount);
    return { name, beam, hit };
  });
  return {
    group,
    /** @param {Robot} robot */
    update(robot) {
      for (const { name, beam, hit } of rays) {
        const range = robot.proximity[name];
        const seen = Number.isFinite(range) || range === -Infinity;
        const length = seen ? Math.max(range, 0.002) : MAX_RANGE_M;
        beam.visible = range !== undefined;
        beam.scale.set(length, length, 1);
        beam.material.opacity = seen ? 0.4 : 0.13;
        hit.visible = seen;
        hit.position.x = length;
        colourOf(seen ? length / MAX_RANGE_M : 1, beam.material.color);
        hit.material.color.copy(beam.material.color);
      }
    },
    dispose() {
      fan.dispose();
      dot.dispose();
      for (const { beam, hit } of rays) {
        beam.material.dispose();
        hit.material.dispose();
      }
    },
  };
}

/** @param {number} share  of the maximum range @param {THREE.Color} target */
function colourOf(share, target) {
  if (share < 0.5) target.copy(NEAR).lerp(MIDDLE, share * 2);
  else target.copy(MIDDLE).lerp(FAR, share * 2 - 1);
}
