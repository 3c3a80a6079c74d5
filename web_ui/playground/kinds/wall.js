// A straight wall between two points; both ends extend by half the thickness so that corners close.

import { boxSolid } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function wall({ start_x_m, start_y_m, end_x_m, end_y_m, thickness_m, height_m, color }) {
  const [dx, dy] = [end_x_m - start_x_m, end_y_m - start_y_m];
  const pose = { x: start_x_m + dx / 2, y: start_y_m + dy / 2, yaw: Math.atan2(dy, dx) };
  return [boxSolid(pose, Math.hypot(dx, dy) + thickness_m, thickness_m, height_m, color)];
}
