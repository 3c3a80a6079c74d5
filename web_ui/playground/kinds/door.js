// A box that slides between two positions while a robot is on a pressure plate that names it; drawn closed.

import { boxSolid } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function door({ closed_x_m, closed_y_m, yaw_rad, size_x_m, size_y_m, height_m, color }) {
  return [boxSolid({ x: closed_x_m, y: closed_y_m, yaw: yaw_rad }, size_x_m, size_y_m, height_m, color)];
}
