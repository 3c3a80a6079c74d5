// A pressure plate with its trigger area; while a robot is in the area, the named door opens.

import { placed } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function activation(values) {
  const pose = poseOf(values);
  return [
    boxSolid(pose, values.size_x_m, values.size_y_m, values.height_m, values.color),
    { type: "trigger", vertices: placed(pose, values.area_m), door: values.door },
  ];
}
