// Checks names and doors of a playground, and whether an item can be built and be at its position. Pure.
// The rules are those of thymio_sim_ros/sim/playground/checks.py; what depends on primitives that the simulator has not
// computed yet is not checked.

import { containsPoint, overlap } from "./geometry.js";
import { kindNamed, ROBOT } from "./kinds/index.js";
import { partsOf, valuesOf } from "./parts.js";
import { check, Fault } from "./rules.js";

/** @typedef {import("./parts.js").Item} Item */
/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./rules.js").Phrase} Phrase */

/**
 * The problem of an item among others; null if there is none.
 *
 * @param {readonly Item[]} others  all items except this one
 * @param {Item} item
 * @returns {Phrase | null}
 */
export function findProblem(others, item) {
  const kind = kindNamed(item.kind);
  if (kind === undefined) return null;
  try {
    const { kind: _kind, ...values } = item;
    check({ ...kind.fields, name: ROBOT.fields.name }, values, "");
    const { fault } = partsOf(item);
    if (fault !== null) throw fault;
  } catch (error) {
    if (!(error instanceof Fault)) throw error;
    const { word, values } = error.expected;
    return { word: "problem.value", values: { ...values, kind: item.kind, key: error.key, reason: word } };
  }
  const blocker = blockerOf(others, item);
  return blocker === null ? null : { word: "problem.blocked", values: { name: blocker } };
}

/**
 * The name of an item in the way, or null: robots must not overlap solid items.
 *
 * @param {readonly Item[]} others
 * @param {Item} item
 */
export function blockerOf(others, item) {
  const mine = partsOf(item).footprints;
  if (mine.length === 0) return null;
  const inTheWay = others.find(
    (other) =>
      (item.kind === "robot" || other.kind === "robot") &&
      partsOf(other).footprints.some((there) => mine.some((here) => overlap(here, there))),
  );
  return inTheWay?.name ?? null;
}

/**
 * Whether an item is on ground. Without any ground, nothing can fall.
 *
 * @param {readonly Item[]} others
 * @param {Item} item
 */
export function isOnGround(others, item) {
  const kind = kindNamed(item.kind);
  if (kind === undefined || kind.group === "ground") return true;
  const grounds = others.map(partsOf).filter(({ floors }) => floors.length > 0);
  if (grounds.some(({ isExact }) => !isExact)) return true; // only the simulator knows
  const floors = grounds.flatMap((ground) => ground.floors);
  if (floors.length === 0) return true;
  return groundPoints(item).every((point) => floors.some((floor) => containsPoint(floor, point)));
}

/**
 * What is wrong with items that were accepted before the simulator had answered, as their names and problems.
 *
 * @param {readonly Item[]} items
 * @returns {{ name: string, problem: Phrase }[]}
 */
export function problemsIn(items) {
  return items.flatMap((item) => {
    const others = item.kind === "robot" ? items.filter((other) => other !== item) : [];
    const problem = findProblem(others, item);
    return problem === null ? [] : [{ name: item.name, problem }];
  });
}

/** Items that extend over an edge: the simulator accepts them with a warning. @param {readonly Item[]} items */
export function itemsOffGround(items) {
  return items.filter((item) => !isOnGround(items, item));
}

/** Whether there is certainly no ground; a shape of a plug-in may be one. @param {readonly Item[]} items */
export function lacksGround(items) {
  return items.every((item) => kindNamed(item.kind) !== undefined && partsOf(item).floors.length === 0);
}

/** @param {Item} item @returns {import("./geometry.js").Point[]} */
function groundPoints(item) {
  const kind = kindNamed(item.kind);
  const values = valuesOf(item);
  if (kind?.path !== undefined && !kind.isRelative) return values[kind.path];
  const keys = kind?.placement === "ends" ? kind.points : (kind?.points ?? []).slice(0, 1);
  return keys.map(([x, y]) => [values[x], values[y]]);
}

/**
 * Check names and doors of a playground whose items are valid individually. Throws a Fault with the key of the error.
 *
 * @param {Playground} playground
 */
export function checkWhole({ items }) {
  const shapes = items.filter(({ kind }) => kind !== "robot");
  const robots = items.filter(({ kind }) => kind === "robot");
  const keyed = [
    ...shapes.map((item, index) => ({ item, key: `shapes[${index}]` })),
    ...robots.map((item, index) => ({ item, key: `robots[${index}]` })),
  ];
  /** @type {Map<string, string>} */ const seen = new Map();
  for (const { item, key } of keyed) {
    const other = seen.get(item.name);
    if (other !== undefined)
      throw new Fault(`${key}.name`, `"${item.name}"`, { word: "fault.ownName", values: { other } });
    seen.set(item.name, key);
  }
  const doors = shapes.filter(({ kind }) => kind === "door").map(({ name }) => name);
  for (const { item, key } of keyed) {
    if (item.kind !== "activation" || doors.includes(item.door)) continue;
    throw new Fault(`${key}.door`, `"${item.door}"`, {
      word: "fault.door",
      values: { names: doors.join(", ") || "–" },
    });
  }
}
