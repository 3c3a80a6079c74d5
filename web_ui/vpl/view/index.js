// Programs as rows of blocks: creates the objects of one view (hosts/program_host.js) and draws them.
//
//   VplEditing        the program, its history, its file (no DOM)
//   rowList, palette  the rows, and the blocks to choose from
//   blockSheet        the editor of a block; rowMenu: what can be done with a row
//   textPane          the text that is made from the blocks
//   noticeList        what the user must know or decide

import { translator } from "../../i18n/index.js";
import TEXTS from "../../i18n/vpl.texts.js";
import { h, setText } from "../../ui/dom.js";
import { makeBlock, nameKey } from "../blocks.js";
import { blockAt, changeBlock, copyRow, insertRow, moveBlock, moveRow, putBlock, putRow, removeBlock, removeRow, slotOf, whyNot } from "../edits.js"; // prettier-ignore
import { withoutVpl } from "../file.js";
import { reportedRow } from "../generator.js";
import { offeredModes } from "../toolbox.js";
import { vplBar } from "./bar.js";
import { blockSheet } from "./block_sheet.js";
import { watchDrags } from "./drag.js";
import { added, draggedOut, dropped } from "./dropping.js";
import { VplEditing } from "./editing.js";
import { watchKeys } from "./keys.js";
import { noticeList } from "./notices.js";
import { palette } from "./palettes.js";
import { picture } from "./picture.js";
import { isSlot, spotOf, written } from "./place.js";
import { questionNotices } from "./questions.js";
import { rowMenu } from "./row_menu.js";
import { rowList } from "./rows.js";
import { sampleText } from "./samples.js";
import { textPane } from "./text_pane.js";

import "./vpl.css";

/** @typedef {import("../../program_tab/tab.js").Parts} Parts */
/** @typedef {import("../../hosts/program_host.js").ProgramView} ProgramView */
/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {import("../program.js").Program} Program */
/** @typedef {import("../program.js").Row} Row */
/** @typedef {import("./dropping.js").Dropped} Dropped */
/** @typedef {import("./place.js").Slot} Slot */
/** @typedef {import("./place.js").Spot} Spot */

const TEXT_KEY = "vpl.text";
/** Lower windows have no room for the text until it is asked for. */
const ROOMY = "(min-width: 900px) and (min-height: 720px)";

/** @implements {ProgramView} */
class VplView {
  /** @type {Slot | null} the slot of the selected row that the next block goes to */ #slot = null;
  /** @type {Spot | null} the block whose editor is open */ #edited = null;
  /** @type {{ block: Block } | { row: Readonly<Row> } | null} a copy that waits for its place */ #held = null;
  /** @type {Mode | null} a mode in which blocks would be lost */ #wanted = null;
  /** @type {import("./dropping.js").Dragged | null} */ #dragged = null;
  /** @type {Element | null} the row below the pointer */ #below = null;
  #lastEvent = 0;
  #told = "";
  #isAsked = false;

  /** @param {Parts} parts */
  constructor(parts) {
    const { context, session, commands, redraw } = parts;
    const t = translator(context.language, TEXTS);
    this.parts = parts;
    this.t = t;
    this.editing = new VplEditing({ workspace: session.workspace, kept: session.texts });
    const { editing } = this;
    const kept = session.storage.getItem(TEXT_KEY);
    this.isTextShown = kept === null ? matchMedia(ROOMY).matches : kept === "on";

    this.rows = rowList({ t });
    /** @param {string} name @param {boolean} isKey */
    const add = (name, isKey) => this.#add(name, isKey);
    this.events = palette({ t, types: ["event", "condition"], add });
    this.actions = palette({ t, types: ["action"], add });
    this.sheet = blockSheet({
      t,
      change: (block, series) => this.#edited && this.#edit(changeBlock(editing.program, place(this.#edited), block), series),
      endSeries: () => editing.endSeries(),
      copy: () => this.#edited && this.#copy(this.#edited),
      remove: () => this.#edited && this.#remove(this.#edited),
      closed: () => this.#sheetClosed(),
    }); // prettier-ignore
    this.menu = rowMenu({ t, act: (verb, row) => this.#actOnRow(verb, row) });
    this.notices = noticeList();
    this.pane = textPane({
      t,
      turn: () => void commands.detach(),
      choose: (line) => this.#select(editing.rowOf(line)),
    });
    this.status = h("p", { class: "vpl-status", hidden: true });
    this.controls = vplBar({
      t,
      undo: () => this.#undo(),
      redo: () => this.#redo(),
      choose: (mode) => this.#chooseMode(mode),
      toggleText: () => this.#toggleText(),
    });
    this.bar = this.controls.element;
    this.entries = /** @type {HTMLElement[]} */ ([]);
    this.element = h(
      "div",
      { class: "vpl" },
      this.events.element,
      h("div", { class: "vpl-program" }, this.notices.element, this.rows.element, this.status, this.pane.element),
      this.actions.element,
      this.sheet.element,
      this.menu.element,
    );
    this.rows.element.addEventListener("click", (event) => this.#click(event));
    this.rows.element.addEventListener("focusin", ({ target }) => this.#focused(target));
    watchKeys(this.element, this.rows.element, this.#keys());
    this.endDrags = watchDrags(this.element, this.rows.element, this.#drags());
    this.redrawSoon = redraw;
  }

  show() {
    this.sheet.close();
    this.#slot = this.#held = this.#wanted = null;
    this.editing.open();
    this.#lastEvent = this.parts.session.state.log.at(-1)?.id ?? 0;
    this.#say("", "good");
    this.rows.setCurrent(written({ row: 0, slot: "event", index: 0 }));
  }

  resized() {}

  hasMistake() {
    return this.editing.isBlocked;
  }

  showMistake() {
    const { refusal } = this.editing;
    if (refusal === null) return;
    this.rows.focus(written({ row: refusal.row, slot: refusal.slot, index: 0 }));
    this.parts.context.announce(this.t(refusal.key, refusal.values));
  }

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  report(text, kind) {
    this.#say(text, kind);
  }

  async loaded() {}

  focus() {
    this.rows.focus();
  }

  destroy() {
    this.sheet.close();
    this.endDrags();
    this.bar.remove();
    this.element.remove();
  }

  redraw() {
    const { editing, t } = this;
    const { session, context } = this.parts;
    const { program, refusal, selected } = editing;
    const modes = offeredModes(session.toolbox);
    this.controls.render({ canUndo: editing.canUndo, canRedo: editing.canRedo, modes, mode: program.mode, isTextShown: this.isTextShown }); // prettier-ignore
    this.events.render(session.toolbox, program.mode);
    this.actions.render(session.toolbox, program.mode);
    const shownRefusal = editing.question === null ? refusal : null;
    this.rows.render({ program, refusal: shownRefusal, selected, slot: this.#slot, isPasting: this.#held !== null && "block" in this.#held });
    this.#showNotices();
    const { text, source } = editing.shown;
    this.pane.render({ isShown: this.isTextShown, text, source, row: selected });
    if (this.#edited !== null) {
      const button = this.rows.element.querySelector(`[data-place="${written(this.#edited)}"]`);
      this.sheet.update(blockAt(program, place(this.#edited)), program.mode, button);
    }
    const told = shownRefusal === null || shownRefusal.hint ? "" : t(shownRefusal.key, shownRefusal.values);
    if (told !== this.#told && told !== "") context.announce(told);
    this.#told = told;
    this.#flash();
  }

  /** Light the rows that have just run in the robot. */
  #flash() {
    const { session, selection } = this.parts;
    const { log } = session.state;
    const last = log.at(-1)?.id ?? 0;
    if (last === this.#lastEvent) return;
    const added = log.filter(({ id, robot }) => id > this.#lastEvent && robot === selection.robot);
    this.#lastEvent = last;
    if (!session.workspace.isInRobot) return;
    const ran = added.map(({ name, values }) => reportedRow(name, values)).filter((row) => row !== null);
    for (const row of new Set(ran)) this.rows.flash(row);
  }

  #showNotices() {
    const { editing, t } = this;
    const decide = (/** @type {boolean} */ isRenewed) => {
      editing.decide(isRenewed);
      this.redrawSoon();
    };
    const shown = questionNotices({
      t,
      editing,
      wanted: this.#wanted,
      decide,
      read: () => (editing.forgetWarnings(), this.redrawSoon()),
      answer: (isYes) => this.#changeMode(isYes),
      turn: () => void this.parts.commands.detach(),
    });
    for (const [id, notice] of Object.entries(shown)) this.notices.set(id, notice);
    const isAsked = editing.question?.isAsked ?? false;
    if (isAsked && !this.#isAsked) this.notices.focus("question");
    this.#isAsked = isAsked;
  }

  // -- edits ----------------------------------------------------------------------------------------------------------

  /** @param {Program} program @param {string} [series] */
  #edit(program, series = "") {
    if (program === this.editing.program) return;
    this.editing.edit(program, series);
    this.#say("", "good");
    this.redrawSoon();
  }

  /** @param {Dropped} result  @returns {boolean} whether it was possible */
  #apply({ program, row, reason }) {
    if (reason !== null) {
      this.#say(this.t(reason.key, reason.values), "warning");
      return false;
    }
    this.editing.selected = row;
    this.#slot = null;
    this.#edit(program);
    return true;
  }

  /** @param {string} name @param {boolean} isKey */
  #add(name, isKey) {
    const { editing, t } = this;
    const result = added(editing.program, name, editing.selected, this.#slot);
    const slot = this.#slot === "conditions" && slotOf(name) !== "actions" ? "conditions" : slotOf(name);
    if (!this.#apply(result)) return;
    this.parts.context.announce(`${t("row", { row: result.row + 1 })}: ${t(nameKey(name))}`);
    const found = editing.program.rows[result.row]?.[slot];
    const index = Array.isArray(found) ? found.length - 1 : 0;
    const spot = written({ row: result.row, slot, index });
    this.redraw();
    if (isKey) this.rows.focus(spot);
    else this.rows.setCurrent(spot);
  }

  /** @param {Spot} spot */
  #remove(spot) {
    const { program } = this.editing;
    if (isSlot(spot)) this.#edit(removeBlock(program, place(spot)));
    else if (spot.row < program.rows.length - 1) this.#edit(removeRow(program, spot.row));
  }

  /** @param {import("./row_menu.js").RowVerb} verb @param {number} row */
  #actOnRow(verb, row) {
    const { program } = this.editing;
    const to = { copy: row + 1, insert: row, up: row - 1, down: row + 1 }[verb];
    if (verb === "copy") this.#edit(copyRow(program, row, to));
    else if (verb === "insert") this.#edit(insertRow(program, row));
    else this.#moveRow(row, to);
    this.redraw();
    this.rows.focus(written({ row: to, slot: "row", index: 0 }));
  }

  /** @param {number} row @param {number} to */
  #moveRow(row, to) {
    const { program } = this.editing;
    if (to < 0 || to >= program.rows.length - 1) return;
    this.editing.selected = to;
    this.#edit(moveRow(program, row, to));
  }

  /** @param {Spot} spot */
  #copy(spot) {
    const { program } = this.editing;
    const block = isSlot(spot) ? blockAt(program, place(spot)) : null;
    if (isSlot(spot) && block === null) return;
    this.#held = block === null ? { row: program.rows[spot.row] } : { block };
    this.#say(this.t("block.held"), "good");
    this.redrawSoon();
  }

  /** Put the copy into a row. @param {Spot} spot */
  #paste(spot) {
    const held = this.#held;
    const { program } = this.editing;
    if (held === null) return;
    if ("row" in held) {
      this.#edit(putRow(program, Math.min(spot.row + 1, program.rows.length - 1), held.row));
      return void this.#cancel();
    }
    const slot = spot.slot === "conditions" ? spot.slot : slotOf(held.block);
    const reason = whyNot(program, spot.row, held.block, slot);
    const isPut = this.#apply({
      program: reason === null ? putBlock(program, spot.row, held.block, { slot }) : program,
      row: spot.row,
      reason,
    });
    if (isPut) this.#cancel();
  }

  #undo() {
    if (!this.editing.canUndo) return;
    this.editing.undo();
    this.#say("", "good");
    this.redrawSoon();
  }

  #redo() {
    if (!this.editing.canRedo) return;
    this.editing.redo();
    this.redrawSoon();
  }

  /** @param {Mode} mode */
  #chooseMode(mode) {
    this.#wanted = mode === this.editing.mode ? null : mode;
    if (this.#wanted !== null && this.editing.lostIn(mode).length === 0) return this.#changeMode(true);
    this.redraw();
    if (this.#wanted !== null) this.notices.focus("loss");
  }

  /** @param {boolean} isChanged */
  #changeMode(isChanged) {
    const wanted = this.#wanted;
    this.#wanted = null;
    if (isChanged && wanted !== null) this.editing.setMode(wanted);
    this.redrawSoon();
  }

  // -- what is selected -----------------------------------------------------------------------------------------------

  /** @param {number | null} row @param {Slot | null} [slot] */
  #select(row, slot = null) {
    this.editing.selected = row;
    this.#slot = slot;
    this.redrawSoon();
  }

  /** @param {EventTarget | null} target */
  #focused(target) {
    const spot = spotOf(target);
    if (spot === null) return;
    this.rows.setCurrent(written(spot));
    if (spot.row !== this.editing.selected) this.#select(spot.row);
  }

  /** @param {MouseEvent} event */
  #click({ target, detail }) {
    const { editing, t } = this;
    const spot = spotOf(target);
    if (spot === null) {
      const row = target instanceof Element ? target.closest("[data-row]") : null;
      if (row instanceof HTMLElement) this.#select(Number(row.dataset.row));
      return;
    }
    const button = /** @type {HTMLElement} */ (/** @type {Element} */ (target).closest("[data-place]"));
    if (spot.slot === "row") return this.menu.open(spot.row, editing.program.rows.length - 1, button);
    if (!isSlot(spot)) return this.#remove(spot);
    const block = blockAt(editing.program, place(spot));
    if (block !== null) {
      this.#select(spot.row);
      this.#edited = spot;
      return this.sheet.open(block, editing.mode, button);
    }
    if (this.#held !== null && "block" in this.#held) return this.#paste(spot);
    const isOff = editing.selected === spot.row && this.#slot === spot.slot;
    const { slot } = spot;
    this.#select(spot.row, isOff ? null : slot);
    this.#say(isOff ? "" : t(`slot.choose.${slot}`), "good");
    if (detail === 0 && !isOff) (spot.slot === "actions" ? this.actions : this.events).focus();
  }

  #sheetClosed() {
    const edited = this.#edited;
    this.#edited = null;
    if (edited !== null && document.activeElement === document.body) this.rows.focus(written(edited));
  }

  /** Give up what is begun. @returns {boolean} whether there was something */
  #cancel() {
    const isBegun = this.#held !== null || this.#slot !== null;
    this.#held = this.#slot = null;
    if (isBegun) this.#say("", "good");
    this.redrawSoon();
    return isBegun;
  }

  #toggleText() {
    this.isTextShown = !this.isTextShown;
    this.parts.session.storage.setItem(TEXT_KEY, this.isTextShown ? "on" : "off");
    this.redrawSoon();
  }

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  #say(text, kind) {
    setText(this.status, text);
    this.status.dataset.kind = kind;
    this.status.hidden = text === "";
    if (text !== "") this.parts.context.announce(text);
  }

  /** @returns {import("./keys.js").KeyActions} */
  #keys() {
    const { editing } = this;
    /** Draw, then focus a place. @param {Spot} spot */
    const focus = (spot) => {
      this.redraw();
      this.rows.focus(written(spot));
    };
    return {
      go: (place) => this.rows.focus(place),
      remove: (spot) => (this.#remove(spot), focus(spot)),
      moveRow: (spot, by) => {
        this.#moveRow(spot.row, spot.row + by);
        focus({ ...spot, row: editing.selected ?? spot.row });
      },
      moveBlock: (spot, by) => {
        if (!isSlot(spot) || spot.index + by < 0) return;
        this.#edit(moveBlock(editing.program, place(spot), spot.row, { at: spot.index + by }));
        focus({ ...spot, index: spot.index + by });
      },
      copyRow: ({ row }) => row < editing.program.rows.length - 1 && this.#actOnRow("copy", row),
      copy: (spot) => this.#copy(spot),
      paste: (spot) => (this.#paste(spot), focus(spot)),
      undo: () => this.#undo(),
      redo: () => this.#redo(),
      cancel: () => this.#cancel(),
    };
  }

  /** @returns {import("./drag.js").Drags} */
  #drags() {
    const { editing } = this;
    /** @param {number} x @param {number} y @returns {{ row: Element | null, spot: Spot | null, isOut: boolean }} */
    const at = (x, y) => {
      const target = document.elementFromPoint(x, y);
      const row = target?.closest("[data-row]") ?? null;
      const index = row instanceof HTMLElement ? Number(row.dataset.row) : editing.program.rows.length - 1;
      const isInRows = target !== null && this.rows.element.contains(target);
      const isCondition = target?.closest(".vpl-conditions") !== null;
      const spot = spotOf(target) ?? { row: index, slot: /** @type {Spot["slot"]} */ (isCondition ? "conditions" : "row"), index: 99 };
      return { row, spot: isInRows ? spot : null, isOut: target?.closest(".vpl-palette") != null };
    };
    /** @param {Element | null} row @param {string} [look] */
    const mark = (row, look) => {
      if (this.#below !== row) this.#below?.classList.remove("drop", "drop-no");
      this.#below = row;
      row?.classList.toggle("drop", look === "drop");
      row?.classList.toggle("drop-no", look === "drop-no");
    };
    return {
      start: (source) => {
        const name = source.dataset.newBlock;
        const spot = spotOf(source);
        this.sheet.close();
        this.#dragged = name ?? spot;
        if (name !== undefined) return picture(makeBlock(name));
        if (spot === null) return null;
        const block = isSlot(spot) ? blockAt(editing.program, place(spot)) : null;
        return block === null ? (source.closest("[data-row]")?.outerHTML ?? null) : picture(block);
      },
      over: (x, y, copy) => {
        const { row, spot } = at(x, y);
        if (this.#dragged === null || spot === null) return mark(null);
        const { reason } = dropped(editing.program, this.#dragged, spot, copy);
        mark(row, reason === null ? "drop" : "drop-no");
      },
      drop: (x, y, copy) => {
        const { spot, isOut } = at(x, y);
        if (this.#dragged === null) return;
        if (spot !== null) this.#apply(dropped(editing.program, this.#dragged, spot, copy));
        else if (isOut && !copy) this.#edit(draggedOut(editing.program, this.#dragged));
      },
      end: () => {
        mark(null);
        this.#dragged = null;
      },
    };
  }
}

/** A spot of a block as the edits name it. @param {Spot} spot @returns {import("../program.js").Place} */
function place({ row, slot, index }) {
  return { row, slot: /** @type {Slot} */ (slot), index };
}

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new VplView(parts);
}

export { sampleText, withoutVpl as withoutPicture };
