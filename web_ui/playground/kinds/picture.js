// An image on the ground: paint, neither an obstacle nor a floor. At yaw 0 it is oriented as on a page.

import { poseOf } from "../primitives.js";
import { needed, optional, RULES } from "../rules.js";

/** @type {import("./index.js").Kind} */
export const picture = {
  name: "picture",
  group: "paint",
  fields: {
    image: needed(RULES.image),
    size_x_m: needed(RULES.extent),
    size_y_m: optional(RULES.extent, null),
    x_m: optional(RULES.coordinate, 0),
    y_m: optional(RULES.coordinate, 0),
    yaw_rad: optional(RULES.angle, 0),
  },
  points: [["x_m", "y_m"]],
  fresh: { size_x_m: 0.4 },
  primitives: (values) => [
    { type: "print", pose: poseOf(values), sizeX: values.size_x_m, sizeY: values.size_y_m, image: values.image },
  ],
};
