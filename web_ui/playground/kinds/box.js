// A box, fixed or movable.

import { boxSolid, poseOf } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function box(values) {
  return [boxSolid(poseOf(values), values.size_x_m, values.size_y_m, values.height_m, values.color)];
}
