// Walls around a ground, shared by all grounds; not a kind.

import { needed, object, optional, RULES } from "../rules.js";

const WALLS = object({
  height_m: optional(RULES.extent, 0.12),
  thickness_m: optional(RULES.extent, 0.02),
  color: optional(RULES.shade, null),
});

/** The fields that all grounds have. @param {import("../rules.js").Fields} own */
export function groundFields(own) {
  return {
    ...own,
    color: needed(RULES.shade),
    x_m: optional(RULES.coordinate, 0),
    y_m: optional(RULES.coordinate, 0),
    yaw_rad: optional(RULES.angle, 0),
    walls: optional(WALLS, null),
  };
}
