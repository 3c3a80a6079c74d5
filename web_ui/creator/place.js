// Position, rotation and control points of items. Pure: every function returns a new item.

import { inFrame, placed, wrapped } from "../playground/geometry.js";
import { kindNamed } from "../playground/kinds/index.js";
import { outlinesOf, valuesOf } from "../playground/parts.js";
import { poseOf } from "../playground/primitives.js";
import { tidy } from "../playground/document.js";
import { rounded } from "./snap.js";

/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */

/** A copy of an item with changed values. @param {Item} item @param {Record<string, any>} values @returns {Item} */
export function changed(item, values) {
  return Object.freeze(tidy({ ...item, ...values }));
}

/** The reference point of an item, about which it turns. @param {Item} item @returns {Point} */
export function middleOf(item) {
  const kind = kindNamed(item.kind);
  const values = valuesOf(item);
  if (kind === undefined) return [0, 0];
  if (kind.placement !== "center") return middle(pointsOf(item));
  const [x, y] = kind.points[0] ?? [];
  return [values[x] ?? 0, values[y] ?? 0]; // a kind without coordinates stays where it is
}

/** @param {Item} item @param {number} dx @param {number} dy */
export function moved(item, dx, dy) {
  const kind = kindNamed(item.kind);
  const values = valuesOf(item);
  /** @type {Record<string, any>} */ const next = {};
  for (const [x, y] of kind?.points ?? []) {
    next[x] = rounded(values[x] + dx);
    next[y] = rounded(values[y] + dy);
  }
  if (kind?.path !== undefined && !kind.isRelative) {
    next[kind.path] = values[kind.path].map((/** @type {Point} */ [x, y]) => [rounded(x + dx), rounded(y + dy)]);
  }
  return changed(item, next);
}

/** Move an item so that its center is at a point. @param {Item} item @param {Point} place */
export function movedTo(item, [x, y]) {
  const [nowX, nowY] = middleOf(item);
  return moved(item, x - nowX, y - nowY);
}

/** Whether turning has an effect on an item. @param {Item} item */
export function canTurn(item) {
  const kind = kindNamed(item.kind);
  return kind !== undefined && ("yaw_rad" in kind.fields || kind.placement !== "center");
}

/** Turn an item about its center, counter-clockwise. @param {Item} item @param {number} angle */
export function turned(item, angle) {
  const kind = kindNamed(item.kind);
  if (kind === undefined || !canTurn(item)) return item;
  const values = valuesOf(item);
  const [x, y] = middleOf(item);
  /** @param {Point} point @returns {Point} */
  const about = ([px, py]) => {
    const [[nextX, nextY]] = placed({ x, y, yaw: angle }, [[px - x, py - y]]);
    return [rounded(nextX), rounded(nextY)];
  };
  /** @type {Record<string, any>} */ const next = {};
  if ("yaw_rad" in kind.fields) next.yaw_rad = roundAngle(values.yaw_rad + angle);
  for (const [keyX, keyY] of kind.points) [next[keyX], next[keyY]] = about([values[keyX], values[keyY]]);
  if (kind.path !== undefined && !kind.isRelative) next[kind.path] = values[kind.path].map(about);
  return changed(item, next);
}

/** The control points of an item in world coordinates. @param {Item} item @returns {Point[]} */
export function pointsOf(item) {
  const kind = kindNamed(item.kind);
  if (kind === undefined) return [];
  const values = valuesOf(item);
  const single =
    kind.points.length > 1 ? kind.points.map(([x, y]) => /** @type {Point} */ ([values[x], values[y]])) : [];
  if (kind.path === undefined) return single;
  return kind.isRelative ? placed(poseOf(values), values[kind.path]) : values[kind.path];
}

/** Move one control point of an item. @param {Item} item @param {number} index @param {Point} place */
export function withPoint(item, index, place) {
  const kind = kindNamed(item.kind);
  if (kind === undefined) return item;
  const [x, y] = [rounded(place[0]), rounded(place[1])];
  if (kind.path === undefined) {
    const [keyX, keyY] = kind.points[index];
    return changed(item, { [keyX]: x, [keyY]: y });
  }
  const values = valuesOf(item);
  const own = kind.isRelative ? inFrame(poseOf(values), [x, y]).map(rounded) : [x, y];
  return changed(item, {
    [kind.path]: values[kind.path].map((/** @type {Point} */ point, /** @type {number} */ at) =>
      at === index ? own : point,
    ),
  });
}

/** The radius of an item about its center. @param {Item} item */
export function reachOf(item) {
  const [x, y] = middleOf(item);
  const corners = outlinesOf(item).flatMap(({ outline }) => outline);
  return Math.max(0.03, ...corners.map(([px, py]) => Math.hypot(px - x, py - y)));
}

/** The heading of an item. @param {Item} item @returns {number} radians */
export function yawOf(item) {
  return valuesOf(item).yaw_rad ?? 0;
}

/** Normalize an angle and round it to thousandths of a degree, as in files. @param {number} angle */
export function roundAngle(angle) {
  const degrees = (wrapped(angle) * 180) / Math.PI;
  return (Math.round(degrees * 1000) / 1000) * (Math.PI / 180) + 0;
}

/** The center of the bounding box of points. @param {readonly Point[]} points @returns {Point} */
function middle(points) {
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return [rounded((Math.min(...xs) + Math.max(...xs)) / 2), rounded((Math.min(...ys) + Math.max(...ys)) / 2)];
}
