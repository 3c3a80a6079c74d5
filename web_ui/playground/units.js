// Display units of numbers: centimeters, degrees, grams. Pure.

/** One row per unit of the file: display unit, factor, and step of the input. */
export const UNITS = /** @type {Record<string, { unit: string, factor: number, step: number }>} */ ({
  m: { unit: "cm", factor: 100, step: 1 },
  rad: { unit: "°", factor: 180 / Math.PI, step: 15 },
  kg: { unit: "g", factor: 1000, step: 10 },
  s: { unit: "s", factor: 1, step: 0.5 },
  "m/s": { unit: "m/s", factor: 1, step: 0.01 },
  degrees: { unit: "°", factor: 1, step: 15 },
  laps: { unit: "", factor: 1, step: 1 },
  "rows, blocks or lines": { unit: "", factor: 1, step: 1 },
});
const PLAIN = { unit: "", factor: 1, step: 0.05 };
/** Resolution of displayed and entered numbers. */
const SHOWN = 1e4;
const EXACT = 1e9;

/** @param {string | undefined} unit  unit in the file */
export function unitOf(unit = "") {
  return UNITS[unit] ?? PLAIN;
}

/** Convert a number of the file to its display unit. @param {number} value @param {string} [unit] */
export function toDisplay(value, unit) {
  return Math.round(value * unitOf(unit).factor * SHOWN) / SHOWN + 0;
}

/** Convert an entered number to the unit of the file. @param {number} value @param {string} [unit] */
export function toFile(value, unit) {
  const { factor } = unitOf(unit);
  return unit === "rad" ? value / factor : Math.round((value / factor) * EXACT) / EXACT + 0;
}
