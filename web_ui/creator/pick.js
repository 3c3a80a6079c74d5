// Hit tests of the pointer: handles of the selected item, and items. Pure.

import { atHeight, hit } from "../move/placed_bodies.js";
import { distance, containsPoint } from "../playground/geometry.js";
import { kindNamed } from "../playground/kinds/index.js";
import { outlinesOf } from "../playground/parts.js";
import { canTurn, middleOf, pointsOf, reachOf } from "./place.js";

/** @typedef {Parameters<typeof hit>[0]} Ray */
/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {{ type: "point", index: number } | { type: "ring" } | { type: "middle" }} Handle */

/** Distance of the turning ring from the outline. */
export const RING_BEYOND_M = 0.03;
const HANDLE_PX = 14;
const TINY_M = 0.006;

/** The item under the pointer: solids first, then the topmost paint. @param {readonly Item[]} items @param {Ray} ray */
export function itemAt(items, ray) {
  const standing = items.flatMap((item) => solidsOf(item));
  const found = hit(ray, standing);
  if (found !== null) return items.find(({ name }) => name === found.body.name) ?? null;
  const place = atHeight(ray, 0);
  if (place === null) return null;
  const point = /** @type {Point} */ ([place.x, place.y]);
  return (
    [...items]
      .reverse()
      .find((item) => outlinesOf(item).some(({ outline, height }) => height === 0 && containsPoint(outline, point))) ?? null
  );
}

/**
 * The handle of an item under the pointer, or null.
 *
 * @param {Item} item
 * @param {Ray} ray
 * @param {number} pixel  pixel size on the ground in meters
 * @returns {Handle | null}
 */
export function handleAt(item, ray, pixel) {
  const ground = atHeight(ray, 0);
  if (ground === null) return null;
  const place = /** @type {Point} */ ([ground.x, ground.y]);
  const near = Math.max(TINY_M, HANDLE_PX * pixel);
  const index = pointsOf(item).findIndex((point) => distance(point, place) < near);
  if (index >= 0) return { type: "point", index };
  if (hasKnob(item) && distance(middleOf(item), place) < near) return { type: "middle" };
  const radius = reachOf(item) + RING_BEYOND_M;
  if (hasRing(item) && Math.abs(distance(middleOf(item), place) - radius) < near) return { type: "ring" };
  return null;
}

/**
 * Whether an item is moved by a knob in its center, because a drag on the ground moves the camera.
 *
 * @param {Item} item
 */
export function hasKnob(item) {
  const group = kindNamed(item.kind)?.group;
  return group === "ground" || item.kind === "picture";
}

/**
 * Whether an item has a turning ring. Grounds are too large for one; they are turned by keys and numbers.
 *
 * @param {Item} item
 */
export function hasRing(item) {
  return canTurn(item) && kindNamed(item.kind)?.group !== "ground";
}

/** The solid parts of an item as bodies for the hit test. @param {Item} item */
function solidsOf(item) {
  return outlinesOf(item)
    .filter(({ height }) => height > 0)
    .map(({ outline, height }) => {
      const polygon = /** @type {[number, number][]} */ ([...outline]);
      return { name: item.name, robot: null, pose: { x: 0, y: 0, yaw: 0 }, outline: [polygon], height };
    });
}
