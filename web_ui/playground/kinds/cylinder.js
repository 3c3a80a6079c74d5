// An upright cylinder, fixed or movable.

import { discSolid } from "../primitives.js";
import { needed, RULES } from "../rules.js";
import { PUSHABLE } from "./_pushable.js";

/** @type {import("./index.js").Kind} */
export const cylinder = {
  name: "cylinder",
  group: "object",
  fields: {
    x_m: needed(RULES.coordinate),
    y_m: needed(RULES.coordinate),
    radius_m: needed(RULES.extent),
    height_m: needed(RULES.extent),
    color: needed(RULES.shade),
    ...PUSHABLE,
  },
  points: [["x_m", "y_m"]],
  fresh: { radius_m: 0.04, height_m: 0.12, color: "#3f88c5" },
  primitives: ({ x_m, y_m, radius_m, height_m, color }) => [
    discSolid({ x: x_m, y: y_m, yaw: 0 }, radius_m, height_m, color),
  ],
};
