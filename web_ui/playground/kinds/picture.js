// An image on the ground: paint, neither an obstacle nor a floor. At yaw 0 it is oriented as on a page.

import { poseOf } from "../primitives.js";

/** @type {import("./index.js").Draw} */
export function picture(values) {
  const { size_x_m: sizeX, size_y_m: sizeY, image } = values;
  return [{ type: "print", pose: poseOf(values), sizeX, sizeY, image }];
}
