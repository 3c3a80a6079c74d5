// A regular octagon of ground, with or without walls.

import { placed } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";

const EIGHTH = Math.PI / 4;

/** @param {number} radius @param {number} angle @returns {import("../geometry.js").Point} */
const polar = (radius, angle) => [radius * Math.cos(angle), radius * Math.sin(angle)];

/** @type {import("./index.js").Draw} */
export function octagon(values) {
  const { side_m: side, color, walls } = values;
  const pose = poseOf(values);
  const corners = Array.from({ length: 8 }, (_, index) =>
    polar(side / 2 / Math.sin(EIGHTH / 2), (index + 0.5) * EIGHTH),
  );
  /** @type {import("../primitives.js").Primitive[]} */
  const found = [{ type: "floor", vertices: placed(pose, corners), color }];
  if (walls === null) return found;
  const { thickness_m: thick, height_m: height } = walls;
  for (let index = 0; index < 8; index++) {
    const [[x, y]] = placed(pose, [polar(side / 2 / Math.tan(EIGHTH / 2), index * EIGHTH)]);
    const yaw = pose.yaw + index * EIGHTH;
    found.push(boxSolid({ x, y, yaw }, thick, side + thick / 2, height, walls.color ?? color));
  }
  return found;
}
