// The edits of a VPL program. Each returns a new program, or the same one where the edit is impossible.

import { canBeCondition, kindOf, makeBlock } from "./blocks.js";
import { includes } from "./kinds.js";
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
  const found = rows[row]?.[slot] ?? null;
  return isList(found) ? (found[index] ?? null) : found;
}

/** @param {Block | readonly Block[] | null} value @returns {value is readonly Block[]} */
function isList(value) {
  return Array.isArray(value);
}

/** The slot of a row that takes a block from a palette. @param {Block | string} block @returns {Place["slot"]} */
export function slotOf(block) {
  const { type } = kindOf(block);
  if (type === "action") return "actions";
  return type === "condition" ? "conditions" : type;
}

/**
 * Why a block cannot be put into a slot of a row, or null if it can.
 *
 * @param {Program} program
 * @param {number} row
 * @param {Block} block
 * @param {Place["slot"]} [slot]      further conditions take events, too
 * @param {number | null} [without]   index of an action that leaves the row
 * @returns {Finding | null}
 */
export function whyNot({ mode, rows }, row, block, slot = slotOf(block), without = null) {
  const values = { row: row + 1 };
  if (rows[row] === undefined) return { key: "edit.row", values: { ...values, rows: rows.length } };
  const needed = slot === "conditions" ? "extended" : kindOf(block).mode;
  if (!includes(mode, needed)) return { key: needed === "extended" ? "edit.extended" : "edit.advanced", values };
  if (slot === "conditions" ? !canBeCondition(block) : slot !== slotOf(block)) return { key: "edit.slot", values };
  const same =
    slot === "actions" && rows[row].actions.some(({ name }, index) => name === block.name && index !== without);
  return same ? { key: "edit.twice", values } : null;
}

/**
 * Put a block into a row: it replaces the event or the state filter; actions and conditions are added at an index.
 *
 * @param {Program} program
 * @param {number} row
 * @param {Block} block
 * @param {{ slot?: Place["slot"], index?: number }} [options]  the index is the end without it
 */
export function putBlock(program, row, block, { slot = slotOf(block), index } = {}) {
  if (whyNot(program, row, block, slot) !== null) return program;
  const found = program.rows[row][slot];
  return withSlot(program, row, slot, isList(found) ? spliced(found, index ?? found.length, 0, block) : block);
}

/** Remove a block; a state filter is emptied. @param {Program} program @param {Place} place */
export function removeBlock(program, { row, slot, index = 0 }) {
  if (blockAt(program, { row, slot, index }) === null) return program;
  const found = program.rows[row][slot];
  if (isList(found)) return withSlot(program, row, slot, spliced(found, index, 1));
  return withSlot(program, row, slot, slot === "state" ? makeBlock("statefilter") : null);
}

/**
 * Move or copy a block to a row; an action or condition gets the index `at`. A state filter is always copied. An event
 * can become a condition, and a condition an event.
 *
 * @param {Program} program
 * @param {Place} from
 * @param {number} row
 * @param {{ at?: number, copy?: boolean, slot?: Place["slot"] }} [options]
 */
export function moveBlock(program, from, row, { at, copy = false, slot = from.slot } = {}) {
  const block = blockAt(program, from);
  if (block === null) return program;
  const leaves = !copy && from.slot !== "state";
  const stays = leaves && from.row === row && from.slot === slot;
  if (stays && slot === "event") return program;
  if (whyNot(program, row, block, slot, stays ? (from.index ?? 0) : null) !== null) return program;
  return putBlock(leaves ? removeBlock(program, from) : program, row, block, { slot, index: at });
}

/**
 * Replace a block by another of its kind: the result of its editor.
 *
 * @param {Program} program
 * @param {Place} place
 * @param {Block} block
 */
export function changeBlock(program, place, block) {
  const { row, slot, index = 0 } = place;
  if (blockAt(program, place)?.name !== block.name) return program;
  if (slot === "conditions" && !canBeCondition(block)) return program;
  const found = program.rows[row][slot];
  return withSlot(program, row, slot, isList(found) ? spliced(found, index, 1, block) : block);
}

/** Insert an empty row in front of a row. @param {Program} program @param {number} at */
export function insertRow({ mode, rows }, at) {
  return makeProgram(mode, spliced(rows, at, 0, emptyRow(mode)));
}

/** @param {Program} program @param {number} row */
export function removeRow(program, row) {
  return program.rows[row] === undefined ? program : makeProgram(program.mode, spliced(program.rows, row, 1));
}

/**
 * Move a row; `to` is its index afterwards.
 *
 * @param {Program} program
 * @param {number} from
 * @param {number} to
 */
export function moveRow(program, from, to) {
  const { mode, rows } = program;
  if (rows[from] === undefined || rows[to] === undefined || from === to) return program;
  return makeProgram(mode, spliced(spliced(rows, from, 1), to, 0, rows[from]));
}

/** Put a row, such as a copy of one, in front of a row. @param {Program} program @param {number} at @param {Readonly<Row>} row */
export function putRow({ mode, rows }, at, row) {
  return makeProgram(mode, spliced(rows, at, 0, row));
}

/** Copy a row; `to` is the index of the copy. @param {Program} program @param {number} from @param {number} to */
export function copyRow(program, from, to) {
  const { mode, rows } = program;
  return rows[from] === undefined ? program : makeProgram(mode, spliced(rows, to, 0, rows[from]));
}

/**
 * @param {Program} program
 * @param {number} row
 * @param {Place["slot"]} slot
 * @param {Block | readonly Block[] | null} content
 */
function withSlot({ mode, rows }, row, slot, content) {
  return makeProgram(mode, spliced(rows, row, 1, makeRow({ [slot]: content }, rows[row])));
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
