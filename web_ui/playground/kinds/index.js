// The kinds of items in a playground: what is declared of them in Python, and how the page places them.

import { BUILT_IN } from "../declarations.js";
import { GenericShape } from "./generic.js";

/** @typedef {import("../declarations.js").DeclaredShape} DeclaredShape */
/**
 * How an item is placed: by one point, by its two ends, or by any number of points.
 *
 * @typedef {"center" | "ends" | "path"} Placement
 */
/**
 * @typedef {object} Kind
 * @property {string} name
 * @property {"ground" | "paint" | "object" | "robot"} group
 * @property {import("../rules.js").Fields} fields   besides `kind`, and for shapes `name`
 * @property {Record<string, any>} sample            values of a new item
 * @property {Record<string, string>} labels         name of the kind by language; empty: the page's texts have it
 * @property {Record<string, Record<string, string>>} fieldLabels   name of each field by language
 * @property {[string, string][]} points   keys of the coordinates that position it; the first pair is its center
 * @property {string | undefined} path     key of a list of points
 * @property {boolean} isRelative          whether the path is in the frame of the item
 * @property {Placement} placement
 * @property {GenericShape | null} shape   its drawing; null for robots
 */

const ENDS = ["start_x_m", "start_y_m", "end_x_m", "end_y_m"];

export const ROBOT = kindOf("robot", "robot", {
  group: "object",
  fields: BUILT_IN.robot,
  sample: {},
  primitives: [],
  labels: {},
  field_labels: {},
});

/** @type {Map<string, Kind>} */
const SHAPES = new Map();
registerShapes(BUILT_IN.shapes);

/** Add kinds of shapes, or replace those of the same names. @param {Record<string, DeclaredShape>} declared */
export function registerShapes(declared) {
  for (const [name, shape] of Object.entries(declared)) {
    if (name !== ROBOT.name) SHAPES.set(name, kindOf(name, shape.group, shape));
  }
}

/** Kinds of shapes: those of the simulator first, then those of plug-ins. */
export function shapeKinds() {
  return [...SHAPES.values()];
}

/** The kind of a name; undefined for one of a plug-in that is not installed here. @param {string} name */
export function kindNamed(name) {
  return name === ROBOT.name ? ROBOT : SHAPES.get(name);
}

/**
 * The names of fields say how a shape is placed: `x_m`, `y_m` are its center, `start_…` and `end_…` its two ends, and a
 * list of points is its path, relative to the center if there is one.
 *
 * @param {string} name
 * @param {Kind["group"]} group
 * @param {DeclaredShape} declared
 * @returns {Kind}
 */
function kindOf(name, group, declared) {
  const { fields, sample, labels, field_labels: fieldLabels } = declared;
  const points = Object.keys(fields).flatMap((key) => {
    const other = key.replace(/x_m$/, "y_m");
    return key !== other && isCoordinate(fields[key]) && isCoordinate(fields[other])
      ? [/** @type {[string, string]} */ ([key, other])]
      : [];
  });
  const path = Object.keys(fields).find((key) => fields[key].type === "points");
  const isRelative = points.length > 0;
  const hasEnds = ENDS.every((key) => points.flat().includes(key));
  /** @type {Placement} */ const placement = hasEnds ? "ends" : path !== undefined && !isRelative ? "path" : "center";
  const kind = { name, group, fields, sample, labels, fieldLabels, points, path, isRelative, placement };
  return { ...kind, shape: group === "robot" ? null : new GenericShape(kind, declared.primitives) };
}

/**
 * Whether a field is a coordinate: a length that may be negative.
 *
 * @param {import("../rules.js").Fields[string] | undefined} field
 */
function isCoordinate(field) {
  return field?.type === "number" && field.unit === "m" && (field.low ?? 0) < 0;
}
