// The U shape of the thesis: three boxes, open toward +x, in units of `unit_m`.

import { placed } from "../geometry.js";
import { boxSolid, poseOf } from "../primitives.js";

/** Center and size of the boxes, in units. */
const PARTS = /** @type {const} */ ([
  [[0, -4], [8, 1]],
  [[-3, 0], [2, 7]],
  [[2, 4], [12, 2]],
]); // prettier-ignore

/** @type {import("./index.js").Draw} */
export function uFigure(values) {
  const pose = poseOf(values);
  const { unit_m: unit, height_m, color } = values;
  return PARTS.map(([[x, y], [sizeX, sizeY]]) => {
    const [[middleX, middleY]] = placed(pose, [[x * unit, y * unit]]);
    return boxSolid({ x: middleX, y: middleY, yaw: pose.yaw }, sizeX * unit, sizeY * unit, height_m, color);
  });
}
