// Grid snapping, and rounding of numbers for files. Pure.

/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {{ size: number, on: "lines" | "centers", isOff?: boolean }} Grid  size in meters; isOff: nothing snaps to it */

/** Available grid sizes in meters. */
export const GRID_SIZES = [0.01, 0.02, 0.05, 0.1];
const MICRO = 1e6;

/**
 * The nearest point of the grid.
 *
 * @param {Point} place
 * @param {Grid | null} grid  null: no grid
 * @returns {Point}
 */
export function snapped([x, y], grid) {
  if (grid === null) return [rounded(x), rounded(y)];
  const offset = grid.on === "centers" ? grid.size / 2 : 0;
  /** @param {number} value */
  const near = (value) => rounded(Math.round((value - offset) / grid.size) * grid.size + offset);
  return [near(x), near(y)];
}

/** Round meters to micrometers so that files stay readable. @param {number} value */
export function rounded(value) {
  return Math.round(value * MICRO) / MICRO + 0; // avoids -0
}

/** @param {number} meters */
export function centimeters(meters) {
  return rounded(meters * 100);
}
