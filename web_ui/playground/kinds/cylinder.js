// An upright cylinder, fixed or movable.

import { discSolid } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function cylinder({ x_m, y_m, radius_m, height_m, color }) {
  return [discSolid({ x: x_m, y: y_m, yaw: 0 }, radius_m, height_m, color)];
}
