// Two wheels that turn with the joint states; the holes of the hub make the rotation visible.

import * as THREE from "three";

import { Instances, placeOf } from "./instances.js";
import { litMaterial } from "./materials.js";
import { merged } from "./merged.js";
import { WHEEL } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const COLORS = { tyre: 0x45403b, flank: 0x353029, hub: 0x98928a, hole: 0x2b2622 };
const HUB_M = 0.0125;
const HOLES = { count: 6, radius: 0.0023, from: 0.0077 };
const SIDES = 20;
/** The right wheel is the left one, turned around; so only the outer face is drawn. */
const TURNED = new THREE.Matrix4().makeRotationZ(Math.PI);

/** @param {import("./robot_instances.js").Capacity} room */
export function createWheels({ robots }) {
  const outer = WHEEL.width / 2;
  /** @param {THREE.BufferGeometry} shape @param {number} y */
  const outward = (shape, y) => shape.rotateX(-Math.PI / 2).translate(0, y, 0);
  const holes = Array.from({ length: HOLES.count }, (_, at) => {
    const angle = (2 * Math.PI * at) / HOLES.count;
    const hole = new THREE.CircleGeometry(HOLES.radius, 4);
    return /** @type {[THREE.BufferGeometry, number]} */ ([
      outward(hole.translate(HOLES.from * Math.cos(angle), HOLES.from * Math.sin(angle), 0), outer + 0.0003),
      COLORS.hole,
    ]);
  });
  const geometry = merged([
    [new THREE.CylinderGeometry(WHEEL.radius, WHEEL.radius, WHEEL.width, SIDES, 1, true), COLORS.tyre],
    [outward(new THREE.RingGeometry(HUB_M, WHEEL.radius, SIDES), outer), COLORS.flank],
    [outward(new THREE.CircleGeometry(HUB_M, 14), outer + 0.0001), COLORS.hub],
    ...holes,
  ]);
  const wheels = new Instances(geometry, litMaterial({ vertexColors: true }), { each: 2, robots });
  return {
    parts: [wheels],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot }) {
      const y = WHEEL.track / 2;
      wheels.put(slot, 0, placeOf({ x: 0, y, z: WHEEL.radius }, { axis: "Y", angle: robot.wheels.left }));
      const turned = placeOf({ x: 0, y, z: WHEEL.radius }, { axis: "Y", angle: -robot.wheels.right });
      wheels.put(slot, 1, turned.premultiply(TURNED));
    },
  };
}
