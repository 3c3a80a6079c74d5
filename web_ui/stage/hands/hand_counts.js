// What the five front sensors measure of a hand before them. Pure.

/** Places of the hand: the front sensors from left to right. */
export const PLACES = /** @type {const} */ (["left", "centerLeft", "center", "centerRight", "right"]);

/** @typedef {typeof PLACES[number]} Place */

/** Counts of the sensor behind the hand: of a hand far away, and of one that touches it. */
const LEAST = 1200;
const MOST = 4500;
/** Share of it that the sensors beside it see. */
const BESIDE = 0.43;
/** The two rear sensors measure what is there. */
const REAR = [-1, -1];

/**
 * The message of `_press/proximity`: counts of the seven sensors, -1: measured; none: all measured.
 *
 * @param {Place | null} place   null: no hand
 * @param {number} near   0: far, 1: it touches
 * @returns {number[]}
 */
export function handCounts(place, near) {
  if (place === null) return [];
  const peak = LEAST + near * (MOST - LEAST);
  const at = PLACES.indexOf(place);
  const shares = [1, BESIDE];
  return [...PLACES.map((_, sensor) => Math.round(peak * (shares[Math.abs(sensor - at)] ?? 0))), ...REAR];
}
