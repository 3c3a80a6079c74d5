// A VPL program: rows (sets) of one event, a state filter in advanced mode, and actions. Immutable.

import { hasCondition, isAdvanced, makeBlock, sameBlock } from "./blocks.js";

/** @typedef {import("./blocks.js").Block} Block */
/**
 * @typedef {object} Row
 * @property {Block | null} event
 * @property {Block | null} state              the state filter; null in basic mode
 * @property {readonly Block[]} actions        each kind at most once
 */
/** @typedef {{ readonly advanced: boolean, readonly rows: readonly Readonly<Row>[] }} Program */
/** @typedef {{ row: number, slot: "event" | "state" | "action", index?: number }} Place  of a block */
/** @typedef {Record<string, string | number>} Values */
/**
 * Something to say about a program or a file: the key of a text in vpl.json, and the values in it.
 *
 * @typedef {object} Finding
 * @property {string} key
 * @property {Values} values
 */

/**
 * @param {Block | null} event
 * @param {Block | null} state
 * @param {readonly Block[]} actions
 * @returns {Readonly<Row>}
 */
export function makeRow(event, state, actions) {
  return Object.freeze({ event, state, actions: Object.freeze([...actions]) });
}

/** @param {boolean} advanced */
export function emptyRow(advanced) {
  return makeRow(null, advanced ? makeBlock("statefilter") : null, []);
}

/**
 * A program; one empty row is added at the end if there is none, and state filters fit the mode.
 *
 * @param {boolean} advanced
 * @param {readonly Readonly<Row>[]} rows
 * @returns {Program}
 */
export function makeProgram(advanced, rows = []) {
  const fitted = rows.map((row) => {
    if ((row.state !== null) === advanced) return row;
    return makeRow(row.event, advanced ? makeBlock("statefilter") : null, row.actions);
  });
  const last = fitted.at(-1);
  if (last === undefined || !isEmptyRow(last)) fitted.push(emptyRow(advanced));
  return Object.freeze({ advanced, rows: Object.freeze(fitted) });
}

/** Whether a row has neither blocks nor a state filter with a condition. @param {Readonly<Row>} row */
export function isEmptyRow({ event, state, actions }) {
  return event === null && actions.length === 0 && !hasCondition(state);
}

/** Whether a row uses something that basic mode lacks. @param {Readonly<Row>} row */
export function isAdvancedRow({ event, state, actions }) {
  return [event, state, ...actions].some(isAdvanced);
}

/** @param {Readonly<Row>} a @param {Readonly<Row>} b */
export function sameRow(a, b) {
  return (
    sameEvent(a, b) &&
    a.actions.length === b.actions.length &&
    a.actions.every((each, index) => sameBlock(each, b.actions[index]))
  );
}

/** Whether two rows have the same event and state filter. @param {Readonly<Row>} a @param {Readonly<Row>} b */
export function sameEvent(a, b) {
  return sameBlock(a.event, b.event) && sameBlock(a.state, b.state);
}

/** @param {Program} a @param {Program} b */
export function sameProgram(a, b) {
  return (
    a.advanced === b.advanced &&
    a.rows.length === b.rows.length &&
    a.rows.every((row, index) => sameRow(row, b.rows[index]))
  );
}

/** @typedef {Block | readonly [string, readonly number[]]} PlainBlock */
/** @typedef {{ event: PlainBlock | null, state: PlainBlock | null, actions: readonly PlainBlock[] }} PlainRow */

/**
 * The program of plain data, such as a saved draft: the same shape, with values that may be missing or impossible.
 *
 * @param {{ advanced: boolean, rows: readonly PlainRow[] }} data
 */
export function programOf({ advanced, rows }) {
  /** @param {PlainBlock | null} plain */
  const block = (plain) => {
    if (plain === null) return null;
    return "name" in plain ? makeBlock(plain.name, plain.values) : makeBlock(plain[0], plain[1]);
  };
  /** @param {readonly PlainBlock[]} plain */
  const blocks = (plain) => plain.map(block).filter((each) => each !== null);
  return makeProgram(
    advanced,
    rows.map(({ event, state, actions }) => makeRow(block(event), block(state), blocks(actions))),
  );
}
