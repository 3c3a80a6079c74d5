// Parsing of typed numbers, and CSV output.

import { GREATEST, LEAST } from "./aesl.js";

/** @typedef {{ values: number[], problem: null } | { values: null, problem: { key: string, values: Record<string, string | number> } }} Parsed */

/**
 * Parse whole numbers separated by spaces or commas.
 *
 * @param {string} text
 * @param {number} count  the required count
 * @param {number} [least]
 * @param {number} [greatest]
 * @returns {Parsed}
 */
export function parseNumbers(text, count, least = LEAST, greatest = GREATEST) {
  const words = text.split(/[\s,;]+/).filter((word) => word !== "");
  if (words.length !== count)
    return { values: null, problem: { key: "number.count", values: { count, found: words.length } } };
  const bad = words.find((word) => !/^[+-]?\d+$/.test(word) || Number(word) < least || Number(word) > greatest);
  if (bad !== undefined)
    return { values: null, problem: { key: "number.range", values: { found: bad, least, greatest } } };
  return { values: words.map(Number), problem: null };
}

/** A table as CSV (RFC 4180). @param {readonly (string | number)[][]} rows */
export function csv(rows) {
  /** @param {string | number} cell */
  const quoted = (cell) => (/[",\r\n]/.test(String(cell)) ? `"${String(cell).replaceAll('"', '""')}"` : String(cell));
  return rows.map((row) => row.map(quoted).join(",") + "\r\n").join("");
}
