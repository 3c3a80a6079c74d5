// A rectangular piece of ground, with or without walls.

import { placed, rectangle as corners } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function rectangle(values) {
  const { size_x_m: sizeX, size_y_m: sizeY, color, walls } = values;
  const pose = poseOf(values);
  /** @type {import("../primitives.js").Primitive[]} */
  const found = [{ type: "floor", vertices: placed(pose, corners(sizeX, sizeY)), color }];
  if (walls === null) return found;
  const { thickness_m: thick, height_m: height } = walls;
  const [x, y] = [sizeX / 2, sizeY / 2];
  for (const [middle, wallX, wallY] of /** @type {const} */ ([
    [[x, 0], thick, sizeY + thick],
    [[0, y], sizeX + thick, thick],
    [[-x, 0], thick, sizeY + thick],
    [[0, -y], sizeX + thick, thick],
  ])) {
    const [[wx, wy]] = placed(pose, [middle]);
    found.push(boxSolid({ x: wx, y: wy, yaw: pose.yaw }, wallX, wallY, height, walls.color ?? color));
  }
  return found;
}
