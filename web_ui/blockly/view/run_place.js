// Where the program of the blocks is halted or has failed. Pure.

import { faultMessage, lineOf } from "../../state/program_status.js";

/**
 * @typedef {object} RunPlace
 * @property {number | null} line    of the program, from 0; null: it runs, or another program does
 * @property {string | null} block   its id
 * @property {string} fault          why the program failed there; empty: it did not
 */

/** @type {RunPlace} */
export const NOWHERE = { line: null, block: null, fault: "" };

/**
 * @param {Readonly<Record<string, string>>} values   status that the runtime reports
 * @param {readonly (string | null)[]} blocks   the block of each line
 * @param {string} language   of the page
 * @returns {RunPlace}
 */
export function runPlace(values, blocks, language) {
  const isFault = values.state === "fault";
  const line = isFault || values.state === "paused" ? lineOf(values) - 1 : -1;
  if (line < 0 && !isFault) return NOWHERE;
  return {
    line: line < 0 ? null : line,
    block: blocks[line] ?? null,
    fault: isFault ? faultMessage(values, language) : "",
  };
}
