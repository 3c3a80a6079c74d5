// Where items are: moving, turning, and the points by which they are taken. Pure; everything gives a new item.

import { placed, wrapped } from "../playground/geometry.js";
import { kindNamed } from "../playground/kinds/index.js";
import { outlinesOf, valuesOf } from "../playground/parts.js";
import { tidy } from "../playground/document.js";
import { rounded } from "./snap.js";

/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */

/** An item with other values. @param {Item} item @param {Record<string, any>} values @returns {Item} */
export function changed(item, values) {
  return Object.freeze(tidy({ ...item, ...values }));
}

/** What an item is placed and turned by. @param {Item} item @returns {Point} */
export function middleOf(item) {
  const kind = kindNamed(item.kind);
  const values = valuesOf(item);
  if (kind === undefined) return [0, 0];
  if (item.kind === "wall" || kind.points.length === 0) return middle(pointsOf(item));
  const [x, y] = kind.points[0];
  return [values[x], values[y]];
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
  if (kind?.path !== undefined && !kind.relative) {
    next[kind.path] = values[kind.path].map((/** @type {Point} */ [x, y]) => [rounded(x + dx), rounded(y + dy)]);
  }
  return changed(item, next);
}

/** An item with its middle somewhere else. @param {Item} item @param {Point} place */
export function movedTo(item, [x, y]) {
  const [nowX, nowY] = middleOf(item);
  return moved(item, x - nowX, y - nowY);
}

/** Whether turning changes it. @param {Item} item */
export function canTurn(item) {
  const kind = kindNamed(item.kind);
  return kind !== undefined && ("yaw_rad" in kind.fields || item.kind === "wall" || kind.points.length === 0);
}

/** Turned about its middle, counter-clockwise. @param {Item} item @param {number} angle */
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
  if ("yaw_rad" in kind.fields) next.yaw_rad = tidyAngle(values.yaw_rad + angle);
  for (const [keyX, keyY] of kind.points) [next[keyX], next[keyY]] = about([values[keyX], values[keyY]]);
  if (kind.path !== undefined && !kind.relative) next[kind.path] = values[kind.path].map(about);
  return changed(item, next);
}

/** The points by which an item is changed one by one, in the world. @param {Item} item @returns {Point[]} */
export function pointsOf(item) {
  const kind = kindNamed(item.kind);
  if (kind === undefined) return [];
  const values = valuesOf(item);
  const single =
    kind.points.length > 1 ? kind.points.map(([x, y]) => /** @type {Point} */ ([values[x], values[y]])) : [];
  if (kind.path === undefined) return single;
  return kind.relative ? placed(poseOf(values), values[kind.path]) : values[kind.path];
}

/** An item with one of these points somewhere else. @param {Item} item @param {number} index @param {Point} place */
export function withPoint(item, index, place) {
  const kind = kindNamed(item.kind);
  if (kind === undefined) return item;
  const [x, y] = [rounded(place[0]), rounded(place[1])];
  if (kind.path === undefined) {
    const [keyX, keyY] = kind.points[index];
    return changed(item, { [keyX]: x, [keyY]: y });
  }
  const values = valuesOf(item);
  const own = kind.relative ? inFrame(poseOf(values), [x, y]) : [x, y];
  return changed(item, {
    [kind.path]: values[kind.path].map((/** @type {Point} */ point, /** @type {number} */ at) =>
      at === index ? own : point,
    ),
  });
}

/** How far an item reaches from its middle. @param {Item} item */
export function reachOf(item) {
  const [x, y] = middleOf(item);
  const corners = outlinesOf(item).flatMap(({ outline }) => outline);
  return Math.max(0.03, ...corners.map(([px, py]) => Math.hypot(px - x, py - y)));
}

/** Which way it looks. @param {Item} item @returns {number} radians */
export function yawOf(item) {
  return valuesOf(item).yaw_rad ?? 0;
}

/** An angle as files hold it: whole thousandths of a degree where it is one. @param {number} angle */
export function tidyAngle(angle) {
  const degrees = (wrapped(angle) * 180) / Math.PI;
  return (Math.round(degrees * 1000) / 1000) * (Math.PI / 180) + 0;
}

/** @param {Record<string, any>} values */
function poseOf({ x_m, y_m, yaw_rad }) {
  return { x: x_m, y: y_m, yaw: yaw_rad };
}

/** @param {{ x: number, y: number, yaw: number }} pose @param {Point} place @returns {Point} */
function inFrame({ x, y, yaw }, [px, py]) {
  const [[u, v]] = placed({ x: 0, y: 0, yaw: -yaw }, [[px - x, py - y]]);
  return [rounded(u), rounded(v)];
}

/** The middle of the box about points. @param {readonly Point[]} points @returns {Point} */
function middle(points) {
  const [xs, ys] = [points.map(([x]) => x), points.map(([, y]) => y)];
  return [rounded((Math.min(...xs) + Math.max(...xs)) / 2), rounded((Math.min(...ys) + Math.max(...ys)) / 2)];
}
