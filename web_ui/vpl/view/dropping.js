// What a drop at a place of the rows does. Pure: the program after it, or why it is impossible.

import { kindOf, makeBlock } from "../blocks.js";
import { blockAt, copyRow, moveBlock, moveRow, putBlock, removeBlock, slotOf, whyNot } from "../edits.js";
import { placeOf } from "./place.js";

/** @typedef {import("../program.js").Finding} Finding */
/** @typedef {import("../program.js").Program} Program */
/** @typedef {import("./place.js").Spot} Spot */
/** What is dragged: a new block of a palette, or a block or a row of the program. @typedef {string | Spot} Dragged */
/**
 * @typedef {{ program: Program, row: number, reason: Finding | null }} Dropped   program: unchanged if it is impossible
 */

/**
 * @param {Program} program
 * @param {Dragged} dragged
 * @param {Spot} spot     below the pointer
 * @param {boolean} copy
 * @returns {Dropped}
 */
export function dropped(program, dragged, spot, copy) {
  const { row } = spot;
  if (typeof dragged !== "string" && dragged.slot === "row") {
    const last = program.rows.length - 1;
    if (copy) return { program: copyRow(program, dragged.row, Math.min(row, last)), row, reason: null };
    return { program: moveRow(program, dragged.row, Math.min(row, last - 1)), row, reason: null };
  }
  const from = typeof dragged === "string" ? null : placeOf(dragged);
  const block = from === null ? makeBlock(/** @type {string} */ (dragged)) : blockAt(program, from);
  if (block === null) return { program, row, reason: null };
  const slot = slotAt(program, block.name, spot, from?.slot);
  const at = spot.slot === slot ? spot.index : undefined;
  const isOwn = from !== null && !copy && from.row === row && from.slot === slot;
  const reason = whyNot(program, row, block, slot, isOwn ? (from.index ?? 0) : null);
  if (reason !== null) return { program, row, reason };
  if (from === null) return { program: putBlock(program, row, block, { slot, index: at }), row, reason };
  return { program: moveBlock(program, from, row, { at, copy, slot }), row, reason };
}

/**
 * The slot that takes a block. Events can be conditions, too: where the pointer is on conditions.
 *
 * @param {Program} program @param {string} name @param {Spot} spot @param {Spot["slot"]} [from]
 */
function slotAt({ mode }, name, spot, from) {
  const isEvent = kindOf(name).type === "event";
  if (mode !== "extended" || !isEvent) return slotOf(name);
  if (spot.slot === "conditions") return "conditions";
  return spot.slot === "event" || from !== "conditions" ? "event" : "conditions";
}

/** A block that is dragged out of the rows is removed. @param {Program} program @param {Dragged} dragged */
export function draggedOut(program, dragged) {
  if (typeof dragged === "string" || dragged.slot === "row" || dragged.slot === "remove") return program;
  return removeBlock(program, { ...dragged, slot: dragged.slot });
}

/**
 * Where a click in a palette puts a block: in the slot that was chosen, else in the selected row if it has room, else
 * in the first row that lacks such a block. It never replaces one.
 *
 * @param {Program} program
 * @param {string} name
 * @param {number | null} selected
 * @param {import("./place.js").Slot | null} chosen
 * @returns {Dropped}
 */
export function added(program, name, selected, chosen) {
  const block = makeBlock(name);
  const isCondition = chosen === "conditions" && kindOf(name).type !== "action";
  const slot = isCondition ? "conditions" : slotOf(name);
  const has = (/** @type {number} */ row) =>
    slot === "event" ? program.rows[row].event !== null : slot === "actions" && program.rows[row].actions.length > 0;
  const free = program.rows.findIndex((_, row) => !has(row));
  const first = free < 0 ? program.rows.length - 1 : free;
  const row = selected === null || (slot === "event" && has(selected)) ? first : selected;
  const reason = whyNot(program, row, block, slot);
  if (reason !== null) return { program, row, reason };
  return { program: putBlock(program, row, block, { slot }), row, reason };
}
