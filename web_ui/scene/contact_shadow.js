// A soft spot under the robot instead of a computed shadow: cheap, and it shows where the robot stands.

import * as THREE from "three";

import { spotTexture } from "./glow.js";
import { Instances, placeOf } from "./instances.js";

const SIZE_M = 0.17;
const DARKEST = 150 / 255;
const PLACE = placeOf({ x: 0.022, y: 0, z: 0.0006 });

/** @param {import("./robot_instances.js").Capacity} room */
export function createContactShadow({ robots }) {
  const texture = spotTexture(48, [0, 0, 0], (share) => DARKEST * Math.min(1, share * 1.8) ** 1.5);
  const material = new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false });
  const shadow = new Instances(new THREE.PlaneGeometry(SIZE_M, SIZE_M), material, { each: 1, robots });
  shadow.mesh.renderOrder = 1;
  return {
    parts: [shadow],
    /** @param {number} slot */
    show(slot) {
      shadow.put(slot, 0, PLACE);
    },
    dispose: () => texture.dispose(),
  };
}
