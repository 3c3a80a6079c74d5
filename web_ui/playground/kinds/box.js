// A box, fixed or movable.

import { boxSolid, poseOf } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";
import { PUSHABLE } from "./_pushable.js";

/** @type {import("./index.js").Kind} */
export const box = {
  name: "box",
  group: "object",
  fields: {
    x_m: needed(RULES.coordinate),
    y_m: needed(RULES.coordinate),
    size_x_m: needed(RULES.extent),
    size_y_m: needed(RULES.extent),
    height_m: needed(RULES.extent),
    color: needed(RULES.shade),
    yaw_rad: optional(RULES.angle, 0),
    ...PUSHABLE,
  },
  points: [["x_m", "y_m"]],
  fresh: { size_x_m: 0.1, size_y_m: 0.1, height_m: 0.1, color: "#e08a2e" },
  primitives: (values) => [boxSolid(poseOf(values), values.size_x_m, values.size_y_m, values.height_m, values.color)],
};
