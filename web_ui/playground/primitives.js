// The primitives of shapes. Pure; the same as in thymio_sim_ros/sim/model/primitives.py.

import { placed, rectangle } from "./geometry.js";

/** @typedef {import("./geometry.js").Point} Point */
/** @typedef {import("./geometry.js").Pose} Pose */
/** @typedef {{ type: "floor", vertices: Point[], color: string }} Floor  a convex polygon */
/** @typedef {{ type: "paint", vertices: Point[], color: string }} Paint  a convex polygon on the ground */
/** @typedef {Floor | Paint} Patch */
/**
 * @typedef {object} Solid
 * @property {"solid"} type
 * @property {Pose} pose
 * @property {readonly [number, number] | null} size  of a box; null for a disc
 * @property {number} radius                          of a disc
 * @property {number} height
 * @property {string} color
 */
/** @typedef {{ type: "print", pose: Pose, sizeX: number, sizeY: number | null, image: string }} Print */
/** @typedef {{ type: "trigger", vertices: Point[], door: string }} Trigger */
/** @typedef {Patch | Solid | Print | Trigger} Primitive */

/**
 * @param {Pose} pose
 * @param {number} sizeX
 * @param {number} sizeY
 * @param {number} height
 * @param {string} color
 * @returns {Solid}
 */
export function boxSolid(pose, sizeX, sizeY, height, color) {
  return { type: "solid", pose, size: [sizeX, sizeY], radius: 0, height, color };
}

/** @param {Pose} pose @param {number} radius @param {number} height @param {string} color @returns {Solid} */
export function discSolid(pose, radius, height, color) {
  return { type: "solid", pose, size: null, radius, height, color };
}

/** The footprint of a solid. @param {Solid} solid @returns {import("./geometry.js").Footprint} */
export function footprintOf({ pose, size, radius }) {
  if (size === null) return { middle: [pose.x, pose.y], radius };
  return { vertices: placed(pose, rectangle(...size)) };
}

/** The pose of an item with these keys; 0 for a yaw that it lacks. @param {Record<string, any>} values @returns {Pose} */
export function poseOf({ x_m, y_m, yaw_rad = 0 }) {
  return { x: x_m, y: y_m, yaw: yaw_rad };
}
