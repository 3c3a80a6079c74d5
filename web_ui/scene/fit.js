// Where a camera stands so that all corners just fit its picture.

import * as THREE from "three";

const MARGIN = 1.05;

/**
 * Where to look and how far to stand along `from`: each side of the picture is a plane through the camera, pushed out
 * to the corner that is farthest.
 *
 * @param {{ fov: number, aspect: number }} camera  degrees upwards, width by height
 * @param {THREE.Vector3[]} corners
 * @param {THREE.Vector3} from  unit vector from the target to the camera
 */
export function fit({ fov, aspect }, corners, from) {
  const right = new THREE.Vector3(0, 0, 1).cross(from).normalize();
  const up = from.clone().cross(right);
  const high = Math.tan((fov * Math.PI) / 360);
  const wide = high * aspect;
  /** @param {THREE.Vector3} axis @param {number} slope */
  const reach = (axis, slope) => {
    let [low, top] = [-Infinity, -Infinity];
    for (const corner of corners) {
      const depth = corner.dot(from) * slope;
      const across = corner.dot(axis);
      low = Math.max(low, depth - across);
      top = Math.max(top, depth + across);
    }
    return { middle: (top - low) / 2, depth: (top + low) / 2 / slope };
  };
  const [sideways, upwards] = [reach(right, wide), reach(up, high)];
  const depth = Math.max(sideways.depth, upwards.depth);
  const eye = right.multiplyScalar(sideways.middle).add(up.multiplyScalar(upwards.middle)).addScaledVector(from, depth);
  const distance = eye.z / from.z;
  return { target: eye.addScaledVector(from, -distance), distance: distance * MARGIN };
}
