// What the user does with a program of blocks: adds, moves, copies and removes blocks and rows, undoes, changes the mode.
// It also has what is begun: a chosen slot, a copy that waits for its place, a mode that would lose blocks.

import { nameKey } from "../blocks.js";
import {
  blockAt,
  copyRow,
  insertRow,
  moveBlock,
  moveRow,
  putBlock,
  putRow,
  removeBlock,
  removeRow,
  slotOf,
  whyNot,
} from "../edits.js";
import { added } from "./dropping.js";
import { isSlot, placeOf, written } from "./place.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {import("../program.js").Program} Program */
/** @typedef {import("../program.js").Row} Row */
/** @typedef {import("./dropping.js").Dropped} Dropped */
/** @typedef {import("./place.js").Slot} Slot */
/** @typedef {import("./place.js").Spot} Spot */

export class VplCommands {
  /** @type {Slot | null} the slot of the selected row that the next block goes to */ slot = null;
  /** @type {Mode | null} a mode in which blocks would be lost */ wanted = null;
  /** @type {{ block: Block } | { row: Readonly<Row> } | null} */ #held = null;

  /**
   * @param {object} options
   * @param {import("../../i18n/index.js").Translate} options.t
   * @param {import("./editing.js").VplEditing} options.editing
   * @param {import("./rows.js").RowList} options.rows
   * @param {(text: string, kind: "good" | "warning") => void} options.say   "": nothing
   * @param {(text: string) => void} options.announce
   * @param {() => void} options.redraw   with the next frame
   * @param {() => void} options.draw     now, so that what is new can get the focus
   */
  constructor({ t, editing, rows, say, announce, redraw, draw }) {
    this.t = t;
    this.editing = editing;
    this.rows = rows;
    this.say = say;
    this.announce = announce;
    this.redraw = redraw;
    this.draw = draw;
  }

  /** Whether a copied block waits for its place. */
  get isPasting() {
    return this.#held !== null && "block" in this.#held;
  }

  /** Another document is shown. */
  forget() {
    this.slot = this.wanted = this.#held = null;
  }

  /** @param {Program} program @param {string} [series] */
  edit(program, series = "") {
    if (program === this.editing.program) return;
    this.editing.edit(program, series);
    this.say("", "good");
    this.redraw();
  }

  /** Make an edit, or say why it is impossible. @param {Dropped} result @returns {boolean} whether it was possible */
  apply({ program, row, reason }) {
    if (reason !== null) {
      this.say(this.t(reason.key, reason.values), "warning");
      return false;
    }
    this.editing.selected = row;
    this.slot = null;
    this.edit(program);
    return true;
  }

  /** Add a block of a palette. @param {string} name @param {boolean} isKey  whether it gets the focus */
  add(name, isKey) {
    const { editing, t, rows } = this;
    const result = added(editing.program, name, editing.selected, this.slot);
    const slot = this.slot === "conditions" && slotOf(name) !== "actions" ? "conditions" : slotOf(name);
    if (!this.apply(result)) return;
    this.announce(`${t("row", { row: result.row + 1 })}: ${t(nameKey(name))}`);
    const found = editing.program.rows[result.row]?.[slot];
    const index = Array.isArray(found) ? found.length - 1 : 0;
    this.draw();
    const place = written({ row: result.row, slot, index });
    if (isKey) rows.focus(place);
    else rows.setCurrent(place);
  }

  /** Remove a block, or the row of a number or a bin. @param {Spot} spot */
  remove(spot) {
    const { program } = this.editing;
    if (isSlot(spot)) this.edit(removeBlock(program, placeOf(spot)));
    else if (spot.row < program.rows.length - 1) this.edit(removeRow(program, spot.row));
  }

  /** @param {import("./row_menu.js").RowVerb} verb @param {number} row */
  actOnRow(verb, row) {
    const { program } = this.editing;
    const to = { copy: row + 1, insert: row, up: row - 1, down: row + 1 }[verb];
    if (verb === "copy") this.edit(copyRow(program, row, to));
    else if (verb === "insert") this.edit(insertRow(program, row));
    else this.moveRow(row, to);
    this.draw();
    this.rows.focus(written({ row: to, slot: "row", index: 0 }));
  }

  /** @param {number} row @param {number} to */
  moveRow(row, to) {
    const { program } = this.editing;
    if (to < 0 || row >= program.rows.length - 1 || to >= program.rows.length - 1) return;
    this.editing.selected = to;
    this.edit(moveRow(program, row, to));
  }

  /** Move an action or a condition in its row. @param {Spot & { slot: Slot }} spot @param {-1 | 1} by */
  moveInRow(spot, by) {
    if (spot.index + by < 0) return;
    this.edit(moveBlock(this.editing.program, placeOf(spot), spot.row, { at: spot.index + by }));
  }

  /** @param {Spot} spot */
  copy(spot) {
    const { program } = this.editing;
    const block = isSlot(spot) ? blockAt(program, placeOf(spot)) : null;
    if (isSlot(spot) && block === null) return;
    this.#held = block === null ? { row: program.rows[spot.row] } : { block };
    this.say(this.t("block.held"), "good");
    this.redraw();
  }

  /** Put the copy into a row, or below it. @param {Spot} spot */
  paste(spot) {
    const held = this.#held;
    const { program } = this.editing;
    if (held === null) return;
    if ("row" in held) {
      this.edit(putRow(program, Math.min(spot.row + 1, program.rows.length - 1), held.row));
      return void this.cancel();
    }
    const slot = spot.slot === "conditions" ? spot.slot : slotOf(held.block);
    const reason = whyNot(program, spot.row, held.block, slot);
    const result = reason === null ? putBlock(program, spot.row, held.block, { slot }) : program;
    if (this.apply({ program: result, row: spot.row, reason })) this.cancel();
  }

  undo() {
    if (!this.editing.canUndo) return;
    this.editing.undo();
    this.say("", "good");
    this.redraw();
  }

  redo() {
    if (!this.editing.canRedo) return;
    this.editing.redo();
    this.redraw();
  }

  /** Choose a mode; returns whether blocks would be lost, which must be asked first. @param {Mode} mode */
  chooseMode(mode) {
    this.wanted = mode === this.editing.mode ? null : mode;
    const isAsked = this.wanted !== null && this.editing.lostIn(mode).length > 0;
    if (!isAsked) this.changeMode(true);
    return isAsked;
  }

  /** The answer to the loss of blocks. @param {boolean} isChanged */
  changeMode(isChanged) {
    const { wanted } = this;
    this.wanted = null;
    if (isChanged && wanted !== null) this.editing.setMode(wanted);
    this.redraw();
  }

  /** @param {number | null} row @param {Slot | null} [slot] */
  select(row, slot = null) {
    this.editing.selected = row;
    this.slot = slot;
    this.redraw();
  }

  /** Give up what is begun. @returns {boolean} whether there was something */
  cancel() {
    const isBegun = this.#held !== null || this.slot !== null;
    this.#held = this.slot = null;
    if (isBegun) this.say("", "good");
    this.redraw();
    return isBegun;
  }
}
