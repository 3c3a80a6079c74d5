// A pressure plate with its trigger area; while a robot is in the area, the named door opens.

import { placed } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";

/** @type {import("./index.js").Kind} */
export const activation = {
  name: "activation",
  group: "object",
  fields: {
    x_m: needed(RULES.coordinate),
    y_m: needed(RULES.coordinate),
    size_x_m: needed(RULES.extent),
    size_y_m: needed(RULES.extent),
    area_m: needed(RULES.area),
    door: needed(RULES.name),
    height_m: optional(RULES.extent, 0.06),
    color: optional(RULES.shade, "#ff0000"),
    yaw_rad: optional(RULES.angle, 0),
  },
  points: [["x_m", "y_m"]],
  path: "area_m",
  relative: true,
  fresh: {
    size_x_m: 0.06,
    size_y_m: 0.03,
    area_m: [[-0.1, -0.02], [0.1, -0.02], [0.1, 0.18], [-0.1, 0.18]], // prettier-ignore
  },
  primitives(values) {
    const pose = poseOf(values);
    return [
      boxSolid(pose, values.size_x_m, values.size_y_m, values.height_m, values.color),
      { type: "trigger", vertices: placed(pose, values.area_m), door: values.door },
    ];
  },
};
