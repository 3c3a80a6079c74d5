// Places on a grid, and numbers as they are written. Pure.

/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {{ size: number, on: "lines" | "centers" }} Grid  size in meters */

/** What can be chosen, in meters. */
export const GRID_SIZES = [0.01, 0.02, 0.05, 0.1];
const MICRO = 1e6;

/**
 * The place of the grid that is nearest.
 *
 * @param {Point} place
 * @param {Grid | null} grid  null: none
 * @returns {Point}
 */
export function snapped([x, y], grid) {
  if (grid === null) return [rounded(x), rounded(y)];
  const offset = grid.on === "centers" ? grid.size / 2 : 0;
  /** @param {number} value */
  const near = (value) => rounded(Math.round((value - offset) / grid.size) * grid.size + offset);
  return [near(x), near(y)];
}

/** Meters to the micrometre, so that files stay readable. @param {number} value */
export function rounded(value) {
  return Math.round(value * MICRO) / MICRO + 0; // never -0
}
