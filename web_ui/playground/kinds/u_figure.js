// The U shape of the thesis: three boxes, open toward +x, in units of `unit_m`.

import { placed } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";

/** Center and size of the boxes, in units. */
const PARTS = /** @type {const} */ ([
  [[0, -4], [8, 1]],
  [[-3, 0], [2, 7]],
  [[2, 4], [12, 2]],
]); // prettier-ignore

/** @type {import("./index.js").Kind} */
export const uFigure = {
  name: "u_figure",
  group: "object",
  fields: {
    unit_m: needed(RULES.extent),
    height_m: needed(RULES.extent),
    color: needed(RULES.shade),
    x_m: optional(RULES.coordinate, 0),
    y_m: optional(RULES.coordinate, 0),
    yaw_rad: optional(RULES.angle, 0),
  },
  points: [["x_m", "y_m"]],
  fresh: { unit_m: 0.03, height_m: 0.12, color: "#9fa3bd" },
  primitives(values) {
    const pose = poseOf(values);
    const { unit_m: unit, height_m, color } = values;
    return PARTS.map(([[x, y], [sizeX, sizeY]]) => {
      const [[middleX, middleY]] = placed(pose, [[x * unit, y * unit]]);
      return boxSolid({ x: middleX, y: middleY, yaw: pose.yaw }, sizeX * unit, sizeY * unit, height_m, color);
    });
  },
};
