// Two wheels that turn with the joint states; spokes make the rotation visible.

import * as THREE from "three";

import { Instances, placeOf } from "./instances.js";
import { merged } from "./merged.js";
import { WHEEL } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const SIDES = /** @type {const} */ (["left", "right"]);
const COLORS = { tyre: 0x343b44, hub: 0xd5dbe2, spoke: 0x6b7684 };

/** @param {import("./robot_instances.js").Capacity} room */
export function createWheels({ robots }) {
  const spoke = () => new THREE.BoxGeometry(0.003, WHEEL.width + 0.0024, 0.024);
  /** @param {number} radius @param {number} width @param {number} corners */
  const disc = (radius, width, corners) => new THREE.CylinderGeometry(radius, radius, width, corners);
  const geometry = merged([
    [disc(WHEEL.radius, WHEEL.width, 28), COLORS.tyre],
    [disc(0.0135, WHEEL.width + 0.0012, 20), COLORS.hub],
    [spoke(), COLORS.spoke],
    [spoke().rotateY(Math.PI / 2), COLORS.spoke],
  ]);
  const material = new THREE.MeshLambertMaterial({ vertexColors: true });
  const wheels = new Instances(geometry, material, { each: 2, robots });
  return {
    parts: [wheels],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot }) {
      SIDES.forEach((side, index) => {
        const place = { x: 0, y: ((1 - 2 * index) * WHEEL.track) / 2, z: WHEEL.radius };
        wheels.put(slot, index, placeOf(place, { axis: "Y", angle: robot.wheels[side] }));
      });
    },
  };
}
