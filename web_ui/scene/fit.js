// Positions a camera so that all corners just fit into its image.

import * as THREE from "three";

const MARGIN = 1.05;

/**
 * The target and the distance along `from`. Each side of the image is a plane through the camera; it is moved outward
 * to the farthest corner, and the planes then determine the position.
 *
 * @param {{ fov: number, aspect: number }} camera  vertical field of view in degrees, width by height
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
