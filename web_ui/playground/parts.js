// The parts of an item, computed once per item and answer of the simulator: items are immutable.

import { BUILT_IN } from "./declarations.js";
import { circle, placed, rectangle } from "./geometry.js";
import { answerCount, noteSilence } from "./kinds/generic.js";
import { kindNamed } from "./kinds/index.js";
import { footprintOf, poseOf } from "./primitives.js";
import { filled } from "./rules.js";
import { ROBOT_HEIGHT_M, ROBOT_OUTLINE } from "./robot_outline.js";

/** @typedef {Readonly<Record<string, any> & { kind: string, name: string }>} Item  a shape, or the start pose of a robot (kind "robot") */
/** @typedef {import("./geometry.js").Footprint} Footprint */
/** @typedef {import("./geometry.js").Point} Point */
/**
 * @typedef {object} Parts
 * @property {Record<string, any>} values       all values, including defaults
 * @property {import("./primitives.js").Primitive[]} primitives   a preview unless exact
 * @property {boolean} isKnown           whether the simulator has answered for these values
 * @property {boolean} isExact           whether the primitives are those of the simulator
 * @property {import("./rules.js").Fault | null} fault   why the simulator cannot build it
 * @property {Footprint[]} footprints    ground on which no other body can stand; empty unless exact
 * @property {Point[][]} floors
 */

const NOTHING = { primitives: [], isKnown: true, fault: null };

/** @type {WeakMap<Item, { parts: Parts, answers: number }>} */
const KNOWN = new WeakMap();

/** @param {Item} item @returns {Parts} */
export function partsOf(item) {
  const known = KNOWN.get(item);
  if (known !== undefined && (known.parts.isKnown || known.answers === answerCount)) return known.parts;
  const values = valuesOf(item);
  const { primitives, isKnown, fault } = kindNamed(item.kind)?.shape?.draw(values) ?? NOTHING;
  const isExact = isKnown && fault === null;
  const solids = primitives.flatMap((part) => (part.type === "solid" ? [part] : []));
  const footprints = item.kind === "robot" ? [robotFootprint(values)] : isExact ? solids.map(footprintOf) : [];
  const floors = primitives.flatMap((part) => (part.type === "floor" ? [part.vertices] : []));
  const parts = { values, primitives, isKnown, isExact, fault, footprints, floors };
  KNOWN.set(item, { parts, answers: answerCount });
  return parts;
}

/**
 * Learn the exact parts of items from the simulator, which is asked for each shape once. Returns whether it has answered.
 *
 * @param {readonly Item[]} items
 * @param {(shapes: string) => Promise<string | null>} ask   the drawings of a list of shapes, both in JSON
 */
export async function learnParts(items, ask) {
  const shapes = new Map(
    items.flatMap((item) => {
      const shape = kindNamed(item.kind)?.shape;
      return !shape || partsOf(item).isKnown ? [] : [[shape.framed(valuesOf(item)).request, shape]];
    }),
  );
  const asked = [...shapes].slice(0, BUILT_IN.limits.shapes);
  if (asked.length === 0) return true;
  const answer = await ask(`[${asked.map(([request]) => request).join()}]`);
  if (answer === null) {
    noteSilence();
    return false;
  }
  const drawings = JSON.parse(answer);
  asked.forEach(([request, shape], index) => shape.learn(request, drawings[index]));
  return true;
}

/** All values of an item, including defaults. @param {Item} item @returns {Record<string, any>} */
export function valuesOf(item) {
  const fields = kindNamed(item.kind)?.fields ?? {};
  return filled(fields, item);
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
