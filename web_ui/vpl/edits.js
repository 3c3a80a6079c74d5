// The edits of a VPL program. Each returns a new program, or the same one where the edit is impossible.

import { kindOf, makeBlock } from "./blocks.js";
import { emptyRow, makeProgram, makeRow } from "./program.js";

/** @typedef {import("./blocks.js").Block} Block */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Place} Place */
/** @typedef {import("./program.js").Program} Program */
/** @typedef {import("./program.js").Row} Row */

/**
 * The block at a place, null if there is none.
 *
 * @param {Program} program
 * @param {Place} place
 * @returns {Block | null}
 */
export function blockAt({ rows }, { row, slot, index = 0 }) {
  const found = rows[row];
  if (found === undefined) return null;
  return slot === "action" ? (found.actions[index] ?? null) : found[slot];
}

/**
 * A copy of a list without `removed` items from an index, and with others there.
 *
 * @template T
 * @param {readonly T[]} list
 * @param {number} at
 * @param {number} removed
 * @param {T[]} added
 */
function spliced(list, at, removed, ...added) {
  return [...list.slice(0, at), ...added, ...list.slice(at + removed)];
}

/**
 * Why a block cannot be put into a row, or null if it can.
 *
 * @param {Program} program
 * @param {number} row
 * @param {Block} block
 * @param {number | null} [without]  index of an action that leaves the row
 * @returns {Finding | null}
 */
export function whyNot({ advanced, rows }, row, block, without = null) {
  const kind = kindOf(block);
  if (rows[row] === undefined) return { key: "edit.row", values: { row: row + 1, rows: rows.length } };
  if (kind.advanced && !advanced) return { key: "edit.advanced", values: { row: row + 1 } };
  const twice =
    kind.type === "action" && rows[row].actions.some(({ name }, index) => name === block.name && index !== without);
  return twice ? { key: "edit.twice", values: { row: row + 1 } } : null;
}

/**
 * Put a block into a row: it replaces the event or the state filter; an action is added at an index.
 *
 * @param {Program} program
 * @param {number} row
 * @param {Block} block
 * @param {number} [index]  of an action; the end without it
 */
export function putBlock(program, row, block, index = program.rows[row]?.actions.length) {
  if (whyNot(program, row, block) !== null) return program;
  const { event, state, actions } = program.rows[row];
  const type = kindOf(block).type;
  if (type === "event") return withRow(program, row, makeRow(block, state, actions));
  if (type === "state") return withRow(program, row, makeRow(event, block, actions));
  return withRow(program, row, makeRow(event, state, spliced(actions, index, 0, block)));
}

/**
 * Add a new block, as a click in a palette does: to the selected row, else to the first row that lacks one.
 *
 * @param {Program} program
 * @param {string} name
 * @param {number | null} selected
 */
export function addBlock(program, name, selected = null) {
  const type = kindOf(name).type;
  const lacking = program.rows.findIndex(({ event, actions }) =>
    type === "event" ? event === null : actions.length === 0,
  );
  return putBlock(program, selected ?? (lacking < 0 ? program.rows.length - 1 : lacking), makeBlock(name));
}

/** Remove a block; a state filter is emptied. @param {Program} program @param {Place} place */
export function removeBlock(program, { row, slot, index = 0 }) {
  const found = program.rows[row];
  if (found === undefined || blockAt(program, { row, slot, index }) === null) return program;
  const { event, state, actions } = found;
  if (slot === "event") return withRow(program, row, makeRow(null, state, actions));
  if (slot === "state") return withRow(program, row, makeRow(event, makeBlock("statefilter"), actions));
  return withRow(program, row, makeRow(event, state, spliced(actions, index, 1)));
}

/**
 * Move or copy a block to a row; an action gets the index `at`. A state filter is always copied.
 *
 * @param {Program} program
 * @param {Place} from
 * @param {number} row
 * @param {{ at?: number, copy?: boolean }} [options]
 */
export function moveBlock(program, from, row, { at, copy = false } = {}) {
  const block = blockAt(program, from);
  if (block === null) return program;
  const leaves = !copy && from.slot !== "state";
  const without = leaves && from.row === row && from.slot === "action" ? (from.index ?? 0) : null;
  if (whyNot(program, row, block, without) !== null) return program;
  if (leaves && from.row === row && from.slot !== "action") return program;
  return putBlock(leaves ? removeBlock(program, from) : program, row, block, at);
}

/**
 * Replace a block by another of its kind: the result of its editor.
 *
 * @param {Program} program
 * @param {Place} place
 * @param {Block} block
 */
export function changeBlock(program, place, block) {
  const old = blockAt(program, place);
  if (old === null || old.name !== block.name) return program;
  const { event, state, actions } = program.rows[place.row];
  if (place.slot === "action")
    return withRow(program, place.row, makeRow(event, state, spliced(actions, place.index ?? 0, 1, block)));
  return withRow(
    program,
    place.row,
    makeRow(place.slot === "event" ? block : event, place.slot === "state" ? block : state, actions),
  );
}

/** Insert an empty row in front of a row. @param {Program} program @param {number} at */
export function insertRow(program, at) {
  return makeProgram(program.advanced, spliced(program.rows, at, 0, emptyRow(program.advanced)));
}

/** @param {Program} program @param {number} row */
export function removeRow(program, row) {
  return program.rows[row] === undefined ? program : makeProgram(program.advanced, spliced(program.rows, row, 1));
}

/**
 * Move a row; `to` is its index afterwards.
 *
 * @param {Program} program
 * @param {number} from
 * @param {number} to
 */
export function moveRow(program, from, to) {
  const { advanced, rows } = program;
  if (rows[from] === undefined || rows[to] === undefined || from === to) return program;
  return makeProgram(advanced, spliced(spliced(rows, from, 1), to, 0, rows[from]));
}

/** Copy a row; `to` is the index of the copy. @param {Program} program @param {number} from @param {number} to */
export function copyRow(program, from, to) {
  const { advanced, rows } = program;
  return rows[from] === undefined ? program : makeProgram(advanced, spliced(rows, to, 0, rows[from]));
}

/** @param {Program} program @param {number} at @param {Readonly<Row>} row */
function withRow({ advanced, rows }, at, row) {
  return makeProgram(advanced, spliced(rows, at, 1, row));
}
