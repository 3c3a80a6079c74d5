// The checks of a VPL program: the first error, from top to bottom, as VPL reports it.

import { BUTTONS, hasCondition } from "./blocks.js";
import { isEmptyRow, sameEvent } from "./program.js";

/** @typedef {import("./program.js").Program} Program */
/**
 * An error, or a hint where all rows below are empty: the row is still being built. Neither program can be run.
 *
 * @typedef {object} Refusal
 * @property {string} key
 * @property {Record<string, number>} values  numbers of rows as pupils count them, from 1
 * @property {"missing-event" | "missing-action" | "same-event-twice"} kind
 * @property {boolean} hint
 * @property {number} row          from 0
 * @property {"event" | "actions"} slot  where the row lacks a block, or has the wrong one
 * @property {number | null} other  the other row with the same event
 */

/** Blocks that have a condition only if something is chosen in them, and the text that says so. */
const CHOICES = /** @type {Record<string, string>} */ ({
  button: "check.any.button",
  prox: "check.any.sensor",
  proxground: "check.any.sensor",
});

/**
 * The key of a warning about a row whose event block, or further condition, has nothing chosen: it is true at each
 * event. Null if there is none.
 *
 * @param {Pick<import("./program.js").Row, "event" | "conditions">} row
 */
export function warningOf({ event, conditions }) {
  const open = [event, ...conditions].find(
    (block) =>
      block !== null && block.name in CHOICES && !hasCondition(block) && (block.name !== "button" || block.values[5] === BUTTONS),
  );
  return open ? CHOICES[open.name] : null;
}

/**
 * The first refusal of a program, or null if it can be run.
 *
 * @param {Program} program
 * @returns {Refusal | null}
 */
export function check({ rows }) {
  for (const [index, row] of rows.entries()) {
    if (isEmptyRow(row)) continue;
    if (row.event === null || row.actions.length === 0) {
      const hint = rows.slice(index + 1).every(isEmptyRow);
      const missing = row.event === null ? "event" : "action";
      const tone = hint ? "add" : "missing";
      const key = `check.${tone}.${missing}`;
      const slot = missing === "event" ? missing : "actions";
      return { key, values: { row: index + 1 }, kind: `missing-${missing}`, hint, row: index, slot, other: null };
    }
    const other = rows.findIndex((each) => sameEvent(each, row));
    if (other < index) {
      const values = { row: index + 1, other: other + 1 };
      return { key: "check.same", values, kind: "same-event-twice", hint: false, row: index, slot: "event", other };
    }
  }
  return null;
}
