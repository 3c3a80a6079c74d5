// A straight wall between two points; both ends extend by half the thickness so that corners close.

import { boxSolid } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";

/** @type {import("./index.js").Kind} */
export const wall = {
  name: "wall",
  group: "object",
  fields: {
    start_x_m: needed(RULES.coordinate),
    start_y_m: needed(RULES.coordinate),
    end_x_m: needed(RULES.coordinate),
    end_y_m: needed(RULES.coordinate),
    color: needed(RULES.shade),
    thickness_m: optional(RULES.extent, 0.02),
    height_m: optional(RULES.extent, 0.12),
  },
  points: [["start_x_m", "start_y_m"], ["end_x_m", "end_y_m"]], // prettier-ignore
  clicks: 2,
  fresh: { color: "#8a97a5" },
  primitives({ start_x_m, start_y_m, end_x_m, end_y_m, thickness_m, height_m, color }) {
    const [dx, dy] = [end_x_m - start_x_m, end_y_m - start_y_m];
    const pose = { x: start_x_m + dx / 2, y: start_y_m + dy / 2, yaw: Math.atan2(dy, dx) };
    return [boxSolid(pose, Math.hypot(dx, dy) + thickness_m, thickness_m, height_m, color)];
  },
};
