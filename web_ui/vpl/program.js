// A VPL program: rows (sets) of one event, a state filter in advanced mode, and actions. Immutable.

import { hasCondition, makeBlock, modeOf, sameBlock } from "./blocks.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./kinds.js").Mode} Mode */
/**
 * @typedef {object} Row
 * @property {Block | null} event
 * @property {Block | null} state              the state filter; null in basic mode
 * @property {readonly Block[]} conditions     further ones, in extended mode
 * @property {readonly Block[]} actions        each kind at most once
 */
/** @typedef {{ readonly mode: Mode, readonly rows: readonly Readonly<Row>[] }} Program */
/** @typedef {{ row: number, slot: "event" | "state" | "conditions" | "actions", index?: number }} Place  of a block */
/**
 * Something to say about a program or a file: the key of a text in vpl.json, and the values in it.
 *
 * @typedef {object} Finding
 * @property {string} key
 * @property {Record<string, string | number>} values
 */

/** An empty row, without state filter. @type {Readonly<Row>} */
export const EMPTY_ROW = Object.freeze({ event: null, state: null, conditions: [], actions: [] });

/** A row with these blocks. @param {Partial<Row>} blocks @param {Readonly<Row>} [row] @returns {Readonly<Row>} */
export function makeRow(blocks, row = EMPTY_ROW) {
  return Object.freeze({ ...row, ...blocks });
}

/** @param {Mode} mode */
export function emptyRow(mode) {
  return fitted(EMPTY_ROW, mode);
}

/** The row with a state filter if its mode has them, else without. @param {Readonly<Row>} row @param {Mode} mode */
function fitted(row, mode) {
  if ((row.state !== null) === (mode !== "basic")) return row;
  return makeRow({ state: mode === "basic" ? null : makeBlock("statefilter") }, row);
}

/**
 * A program; one empty row is added at the end if there is none, and state filters fit the mode.
 *
 * @param {Mode} mode
 * @param {readonly Readonly<Row>[]} [rows]
 * @returns {Program}
 */
export function makeProgram(mode, rows = []) {
  const all = rows.map((row) => fitted(row, mode));
  const last = all.at(-1);
  if (last === undefined || !isEmptyRow(last)) all.push(emptyRow(mode));
  return Object.freeze({ mode, rows: Object.freeze(all) });
}

/** The blocks of a row, in the order of files. @param {Readonly<Row>} row @returns {Block[]} */
export function blocksOf({ event, state, conditions, actions }) {
  return [event, state, ...conditions, ...actions].filter((block) => block !== null);
}

/** Whether a row has neither blocks nor a state filter with a condition. @param {Readonly<Row>} row */
export function isEmptyRow({ event, state, conditions, actions }) {
  return event === null && conditions.length === 0 && actions.length === 0 && !hasCondition(state);
}

/** Whether a row uses something that basic mode lacks. @param {Readonly<Row>} row */
export function isAdvancedRow(row) {
  return row.conditions.length > 0 || blocksOf(row).some((block) => modeOf(block) !== "basic");
}

/** Whether something is tested besides the event. @param {Readonly<Row>} row */
export function hasFilter({ state, conditions }) {
  return hasCondition(state) || conditions.length > 0;
}

/** @param {Readonly<Row>} a @param {Readonly<Row>} b */
export function sameRow(a, b) {
  return sameEvent(a, b) && sameBlocks(a.actions, b.actions);
}

/** Whether rows have the same event, state filter, conditions. @param {Readonly<Row>} a @param {Readonly<Row>} b */
export function sameEvent(a, b) {
  return sameBlock(a.event, b.event) && sameBlock(a.state, b.state) && sameBlocks(a.conditions, b.conditions);
}

/** @param {readonly Block[]} a @param {readonly Block[]} b */
function sameBlocks(a, b) {
  return a.length === b.length && a.every((each, index) => sameBlock(each, b[index]));
}

/** @param {Program} a @param {Program} b */
export function sameProgram(a, b) {
  return (
    a.mode === b.mode && a.rows.length === b.rows.length && a.rows.every((row, index) => sameRow(row, b.rows[index]))
  );
}

/**
 * The program of plain data, such as a saved draft: the same shape, with values that may be missing or impossible.
 *
 * @param {{ mode: Mode, rows: readonly Partial<Row>[] }} data
 */
export function programOf({ mode, rows }) {
  /** @param {Block | null} plain */
  const block = (plain) => (plain === null ? null : makeBlock(plain.name, plain.values));
  /** @param {readonly Block[]} plain */
  const blocks = (plain) => plain.map(({ name, values }) => makeBlock(name, values));
  return makeProgram(
    mode,
    rows.map(({ event = null, state = null, conditions = [], actions = [] }) =>
      makeRow({ event: block(event), state: block(state), conditions: blocks(conditions), actions: blocks(actions) }),
    ),
  );
}
