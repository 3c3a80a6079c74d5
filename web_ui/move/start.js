// The pose for returning a fallen robot: its start, or the nearest free position. No DOM, no 3D scene.

import { parse } from "../playground/document.js";
import { ROBOT_HEIGHT_M, ROBOT_OUTLINE } from "../playground/robot_outline.js";
import { blocker, floors, isInside, obstacles } from "./placed_bodies.js";

/** @typedef {import("./placed_bodies.js").Pose} Pose */

/** Distances and number of directions that are tried around the start, in this order. */
const DISTANCES_M = [0.15, 0.3, 0.45];
const DIRECTIONS = 8;

/**
 * The pose for a robot; its start if no other position is free.
 *
 * @param {import("../state/index.js").State} state
 * @param {string} text    the playground as JSON text
 * @param {string} name    name of the robot in the world
 * @returns {Pose}
 */
export function startOf(state, text, name) {
  const { items } = parse(text);
  const robots = items.filter(({ kind }) => kind === "robot");
  const own = robots.find((robot) => robot.name === name) ?? robots[0]; // a robot that was added later has no start pose
  const start = { x: own?.x_m ?? 0, y: own?.y_m ?? 0, yaw: own?.yaw_rad ?? 0 };
  const body = { name, robot: name, pose: start, outline: [ROBOT_OUTLINE], height: ROBOT_HEIGHT_M };
  const others = obstacles(state, name);
  const grounds = floors(state);
  /** @param {Pose} pose */
  const isFree = (pose) =>
    blocker(body, pose, others) === null && (grounds.length === 0 || grounds.some((ground) => isInside(ground, pose)));
  return [start, ...around(start)].find(isFree) ?? start;
}

/** @param {Pose} start @returns {Pose[]} */
function around({ x, y, yaw }) {
  return DISTANCES_M.flatMap((far) =>
    Array.from({ length: DIRECTIONS }, (_, step) => {
      const angle = (2 * Math.PI * step) / DIRECTIONS;
      return { x: x + far * Math.cos(angle), y: y + far * Math.sin(angle), yaw };
    }),
  );
}
