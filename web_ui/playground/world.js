// A playground as the state of a paused simulator, for drawing it in the creator and in the gallery.

import { INITIAL } from "../state/index.js";
import { NEW_ROBOT } from "../state/robot.js";
import { valuesOf } from "./parts.js";

/** @typedef {import("./parts.js").Item} Item */
/** @typedef {import("../state/index.js").State} State */

/** @type {WeakMap<Item, import("../state/robot.js").Robot>} */
const KNOWN = new WeakMap();

/** @param {readonly Item[]} items @param {import("./markers.js").Markers} markers @returns {State} */
export function worldOf(items, markers) {
  const robots = Object.fromEntries(
    items.filter(({ kind }) => kind === "robot").map((item) => [item.name, robotOf(item)]),
  );
  return { ...INITIAL, markers: markers.of(items), robots };
}

/** @param {Item} item */
function robotOf(item) {
  let robot = KNOWN.get(item);
  if (robot === undefined) {
    const { x_m: x, y_m: y, yaw_rad: yaw } = valuesOf(item);
    robot = { ...NEW_ROBOT, latest: { pose: { x, y, z: 0, yaw, roll: 0, pitch: 0 }, stampNs: 0, arrivedMs: 0 } };
    KNOWN.set(item, robot);
  }
  return robot;
}
