// The parts of an item, computed once per item: items are immutable.

import { circle, placed, rectangle } from "./geometry.js";
import { kindNamed } from "./kinds/index.js";
import { footprintOf, poseOf } from "./primitives.js";
import { ROBOT_HEIGHT_M, ROBOT_OUTLINE } from "./robot_outline.js";

/** @typedef {Readonly<Record<string, any> & { kind: string, name: string }>} Item  a shape, or the start pose of a robot (kind "robot") */
/** @typedef {import("./geometry.js").Footprint} Footprint */
/** @typedef {import("./geometry.js").Point} Point */
/**
 * @typedef {object} Parts
 * @property {Record<string, any>} values       all values, including defaults
 * @property {import("./primitives.js").Primitive[]} primitives
 * @property {boolean} isExact           whether the primitives are those of the simulator
 * @property {Footprint[]} footprints    ground on which no other body can stand; empty unless exact
 * @property {Point[][]} floors
 */

/** @type {WeakMap<Item, Parts>} */
const KNOWN = new WeakMap();

/** Throws a Fault if the item cannot be built. @param {Item} item @returns {Parts} */
export function partsOf(item) {
  const known = KNOWN.get(item);
  if (known !== undefined) return known;
  const kind = kindNamed(item.kind);
  const values = valuesOf(item);
  const primitives = kind?.draw(values) ?? [];
  const isExact = kind === undefined || kind.isExact(values);
  const solids = primitives.filter((part) => part.type === "solid");
  const footprints = item.kind === "robot" ? [robotFootprint(values)] : isExact ? solids.map(footprintOf) : [];
  const floors = primitives.flatMap((part) => (part.type === "floor" ? [part.vertices] : []));
  const parts = { values, primitives, isExact, footprints, floors };
  KNOWN.set(item, parts);
  return parts;
}

/** All values of an item, including defaults. @param {Item} item @returns {Record<string, any>} */
export function valuesOf(item) {
  const fields = kindNamed(item.kind)?.fields ?? {};
  return filled(fields, item);
}

/** @param {import("./rules.js").Fields} fields @param {Record<string, any>} given @returns {Record<string, any>} */
function filled(fields, given) {
  const values = { ...given };
  for (const [key, field] of Object.entries(fields)) {
    if (!(key in given)) values[key] = field.default;
    else if (field.type === "object" && given[key] !== null) values[key] = filled(field.fields ?? {}, given[key]);
  }
  return values;
}

/**
 * The areas that an item covers, as polygons for drawing and hit tests, with their heights.
 *
 * @param {Item} item
 * @returns {{ outline: Point[], height: number }[]}
 */
export function outlinesOf(item) {
  if (item.kind === "robot") return [{ outline: placed(poseOf(valuesOf(item)), ROBOT_OUTLINE), height: ROBOT_HEIGHT_M }];
  return partsOf(item).primitives.flatMap((part) => {
    if (part.type === "floor" || part.type === "paint") return [{ outline: part.vertices, height: 0 }];
    if (part.type === "trigger") return [];
    if (part.type === "print") {
      return [{ outline: placed(part.pose, rectangle(part.sizeX, part.sizeY ?? part.sizeX)), height: 0 }];
    }
    const footprint = footprintOf(part);
    const outline = "radius" in footprint ? placed(part.pose, circle(footprint.radius)) : [...footprint.vertices];
    return [{ outline, height: part.height }];
  });
}

/** @param {Record<string, any>} values @returns {Footprint} */
function robotFootprint(values) {
  return { vertices: placed(poseOf(values), ROBOT_OUTLINE) };
}
