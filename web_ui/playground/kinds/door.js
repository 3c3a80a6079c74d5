// A box that slides between two positions while a robot is on a pressure plate that names it.

import { boxSolid } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";

/** @type {import("./index.js").Kind} */
export const door = {
  name: "door",
  group: "object",
  fields: {
    closed_x_m: needed(RULES.coordinate),
    closed_y_m: needed(RULES.coordinate),
    opened_x_m: needed(RULES.coordinate),
    opened_y_m: needed(RULES.coordinate),
    size_x_m: needed(RULES.extent),
    size_y_m: needed(RULES.extent),
    height_m: needed(RULES.extent),
    move_s: needed(RULES.duration),
    color: needed(RULES.shade),
    yaw_rad: optional(RULES.angle, 0),
  },
  points: [["closed_x_m", "closed_y_m"], ["opened_x_m", "opened_y_m"]], // prettier-ignore
  fresh: { opened_x_m: 0.2, opened_y_m: 0, size_x_m: 0.2, size_y_m: 0.02, height_m: 0.1, move_s: 2, color: "#3f88c5" },
  primitives: ({ closed_x_m, closed_y_m, yaw_rad, size_x_m, size_y_m, height_m, color }) => [
    boxSolid({ x: closed_x_m, y: closed_y_m, yaw: yaw_rad }, size_x_m, size_y_m, height_m, color),
  ],
};
