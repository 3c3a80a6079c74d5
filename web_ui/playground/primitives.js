// The primitives of shapes. Pure; as thymio_sim_ros/sim/model/primitive_declarations.py writes them.

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
 * @property {readonly [number, number]} [size]   of a box
 * @property {number} [radius]                    of a disc
 * @property {readonly Point[]} [vertices]        of a convex polygon, in the frame of its pose
 * @property {number} height
 * @property {string} color
 */
/** @typedef {{ type: "print", pose: Pose, sizeX: number, sizeY: number | null, image: string }} Print  sizeY: null keeps the proportions of the image */
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
  return { type: "solid", pose, size: [sizeX, sizeY], height, color };
}

/** The footprint of a solid. @param {Solid} solid @returns {import("./geometry.js").Footprint} */
export function footprintOf({ pose, size: [sizeX, sizeY] = [0, 0], radius, vertices = rectangle(sizeX, sizeY) }) {
  if (radius !== undefined) return { middle: [pose.x, pose.y], radius };
  return { vertices: placed(pose, vertices) };
}

/** The pose of an item with these keys; 0 for a yaw that it lacks. @param {Record<string, any>} values @returns {Pose} */
export function poseOf({ x_m, y_m, yaw_rad = 0 }) {
  return { x: x_m, y: y_m, yaw: yaw_rad };
}
