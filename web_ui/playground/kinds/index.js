// The kinds of items in a playground. To add one: a file, and a line here.

import { activation } from "./activation.js";
import { box } from "./box.js";
import { cylinder } from "./cylinder.js";
import { door } from "./door.js";
import { octagon } from "./octagon.js";
import { picture } from "./picture.js";
import { rectangle } from "./rectangle.js";
import { robot } from "./robot.js";
import { track } from "./track.js";
import { uFigure } from "./u_figure.js";
import { wall } from "./wall.js";

/**
 * @typedef {object} Kind
 * @property {string} name
 * @property {"ground" | "paint" | "object" | "robot"} group
 * @property {import("../rules.js").Fields} fields   besides `kind`, and for shapes `name`
 * @property {[string, string][]} points   keys of the coordinates that position it; the first pair is its center
 * @property {string} [path]        key of a list of points
 * @property {boolean} [relative]   whether the path is in the frame of the item
 * @property {number} [clicks]      number of points to click; default 1
 * @property {Record<string, any>} fresh   values of a new item
 * @property {(values: Record<string, any>) => import("../primitives.js").Primitive[]} primitives  from all values
 */

/** Kinds of shapes. */
export const SHAPES = /** @type {Kind[]} */ ([
  rectangle,
  octagon,
  picture,
  track,
  box,
  cylinder,
  wall,
  uFigure,
  door,
  activation,
]);
export const ROBOT = robot;
const BY_NAME = new Map([...SHAPES, robot].map((kind) => [kind.name, kind]));

/** The kind of a name; undefined for one of a plug-in. @param {string} name */
export function kindNamed(name) {
  return BY_NAME.get(name);
}
