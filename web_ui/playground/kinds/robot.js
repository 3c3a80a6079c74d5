// The start pose of a robot. Not a shape, but it is placed, moved and turned like one.

import { needed, object, optional, RULES } from "../rules.js";

const PEN = object({
  color: optional(RULES.shade, "#000000"),
  width_m: optional(RULES.penWidth, 0.003),
  down: optional(RULES.flag, true),
});

/** @type {import("./index.js").Kind} */
export const robot = {
  name: "robot",
  group: "robot",
  fields: {
    name: needed(RULES.name),
    x_m: needed(RULES.coordinate),
    y_m: needed(RULES.coordinate),
    yaw_rad: optional(RULES.angle, 0),
    pen: optional(PEN, null),
  },
  points: [["x_m", "y_m"]],
  fresh: {},
  primitives: () => [],
};
