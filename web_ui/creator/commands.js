// Edit commands of the creator: pure functions from one playground to the next.

import { kindNamed } from "../playground/kinds/index.js";
import { outlinesOf } from "../playground/parts.js";
import { changed, moved } from "./place.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/parts.js").Item} Item */

const COPY_AWAY_M = 0.1;
const LEAST_GROUND_M = 1;
/** Margin of ground around the items on it, in meters. */
const MARGIN_M = 0.1;

/** @param {string} title @returns {Playground} */
export function newPlayground(title) {
  const walls = { height_m: 0.1, color: "#7c8b9a" };
  return {
    title,
    description: "",
    translations: {},
    items: [
      { kind: "rectangle", name: "ground", size_x_m: 1, size_y_m: 1, color: "#f3efe4", walls },
      { kind: "robot", name: "thymio", x_m: 0, y_m: 0 },
    ],
  };
}

/** An unused name for a new item. @param {Playground} playground @param {string} wanted */
export function freeName({ items }, wanted) {
  const taken = new Set(items.map(({ name }) => name));
  const stem = wanted
    .replace(/_?\d+$/, "")
    .slice(0, 50)
    .replace(/_$/, "");
  if (!taken.has(stem) && kindNamed(stem) === undefined) return stem;
  for (let number = 1; ; number++) if (!taken.has(`${stem}_${number}`)) return `${stem}_${number}`;
}

/** @param {Playground} playground @param {string | null} name @returns {Item | null} */
export function itemNamed({ items }, name) {
  return items.find((item) => item.name === name) ?? null;
}

/** All items except the named one. @param {Playground} playground @param {string} name */
export function othersOf({ items }, name) {
  return items.filter((item) => item.name !== name);
}

/**
 * Add an item: above all other shapes. Robots stay last, as in the file.
 *
 * @param {Playground} playground
 * @param {Item} item
 * @returns {Playground}
 */
export function added(playground, item) {
  const robots = playground.items.filter(({ kind }) => kind === "robot");
  const shapes = playground.items.filter(({ kind }) => kind !== "robot");
  return { ...playground, items: item.kind === "robot" ? [...shapes, ...robots, item] : [...shapes, item, ...robots] };
}

/**
 * Replace the named item. Plates of a renamed door refer to its new name.
 *
 * @param {Playground} playground
 * @param {string} name
 * @param {Item} item
 * @returns {Playground}
 */
export function replaced(playground, name, item) {
  const items = playground.items.map((one) => {
    if (one.name === name) return item;
    return one.kind === "activation" && one.door === name && item.name !== name
      ? changed(one, { door: item.name })
      : one;
  });
  return { ...playground, items };
}

/**
 * Remove an item. Plates of a removed door are removed too.
 *
 * @param {Playground} playground
 * @param {string} name
 * @returns {Playground}
 */
export function removed(playground, name) {
  const items = playground.items.filter(
    (item) => item.name !== name && !(item.kind === "activation" && item.door === name),
  );
  return { ...playground, items };
}

/** A copy of an item, next to it, with an unused name. @param {Playground} playground @param {Item} item */
export function copyOf(playground, item) {
  return changed(moved(item, COPY_AWAY_M, -COPY_AWAY_M), { name: freeName(playground, item.name) });
}

/**
 * Move an item above (1) or below (-1) its neighbor: later paint covers earlier paint.
 *
 * @param {Playground} playground
 * @param {string} name
 * @param {number} by
 * @returns {Playground}
 */
export function raised(playground, name, by) {
  const items = [...playground.items];
  const from = items.findIndex((item) => item.name === name);
  const to = from + by;
  if (from < 0 || to < 0 || to >= items.length || items[to].kind === "robot") return playground;
  [items[from], items[to]] = [items[to], items[from]];
  return { ...playground, items };
}

/** @param {Playground} playground @param {Partial<Playground>} titles @returns {Playground} */
export function titled(playground, titles) {
  return { ...playground, ...titles };
}

/**
 * Replace the main ground by one of another kind, or by none; position, color, walls and approximate size are kept.
 *
 * @param {Playground} playground
 * @param {string} kind
 * @returns {Playground}
 */
export function grounded(playground, kind) {
  const old = groundOf(playground);
  if ((old?.kind ?? "none") === kind) return playground;
  const others = playground.items.filter((item) => item !== old);
  const wanted = kindNamed(kind);
  if (wanted === undefined) return { ...playground, items: others };
  const {
    size_x_m: x = 1,
    size_y_m: y = 1,
    side_m: side = 0.4142,
    ...rest
  } = /** @type {Record<string, any>} */ (old ?? {});
  const across = side * (1 + Math.SQRT2);
  const size =
    kind === "octagon"
      ? { side_m: round(Math.min(x, y) / (1 + Math.SQRT2)) }
      : { size_x_m: round(across), size_y_m: round(across) };
  const name = freeName({ ...playground, items: others }, "ground");
  const values = { ...wanted.sample, color: "#f3efe4", ...rest, ...size };
  const own = Object.fromEntries(Object.entries(values).filter(([key]) => key in wanted.fields));
  const ground = /** @type {Item} */ (Object.freeze({ kind, name, ...own }));
  return { ...playground, items: [ground, ...others] };
}

/**
 * Add a rectangular ground below all items.
 *
 * @param {Playground} playground
 * @returns {Playground}
 */
export function withGround(playground) {
  const corners = playground.items.flatMap((item) => outlinesOf(item).flatMap(({ outline }) => outline));
  /** @param {0 | 1} axis */
  const span = (axis) => {
    const along = corners.map((corner) => corner[axis]);
    const [low, high] = corners.length === 0 ? [0, 0] : [Math.min(...along), Math.max(...along)];
    return { middle: round((low + high) / 2), size: round(Math.max(LEAST_GROUND_M, high - low + 2 * MARGIN_M)) };
  };
  const [x, y] = [span(0), span(1)];
  const next = grounded(playground, "rectangle");
  const ground = groundOf(next);
  if (ground === null) return next;
  const place = { x_m: x.middle, y_m: y.middle, size_x_m: x.size, size_y_m: y.size };
  return replaced(next, ground.name, changed(ground, place));
}

/** The main ground: the first one. @param {Playground} playground */
export function groundOf({ items }) {
  return items.find(({ kind }) => kindNamed(kind)?.group === "ground") ?? null;
}

/** @param {number} meters */
function round(meters) {
  return Math.round(meters * 1000) / 1000;
}
