// Programs as rows of blocks: creates the objects of one view (hosts/program_host.js) and draws them.
//
//   VplEditing        the program, its history, its file (no DOM)
//   VplCommands       what the user does with it
//   RowList, palette  the rows, and the blocks to choose from
//   BlockSheet        the editor of a block; rowMenu: what can be done with a row
//   textPane          the text that is made from the blocks
//   noticeList        what the user must know or decide

import { trySetItem } from "../../browser/local_storage.js";
import { translator } from "../../i18n/index.js";
import TEXTS from "../../i18n/vpl.texts.js";
import { textPane } from "../../program_tab/text_pane.js";
import { h, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { blockAt, changeBlock } from "../edits.js";
import { withoutVpl } from "../file.js";
import { reportedRow } from "../generator.js";
import { offeredModes } from "../toolbox.js";
import { vplBar } from "./bar.js";
import { BlockSheet } from "./block_sheet.js";
import { VplCommands } from "./commands.js";
import { dragBlocks } from "./drag_blocks.js";
import { VplEditing } from "./editing.js";
import { watchKeys } from "./keys.js";
import { noticeList } from "./notices.js";
import { palette } from "./palettes.js";
import { isSlot, placeOf, spotOf, written } from "./place.js";
import { questionNotices } from "./questions.js";
import { rowMenu } from "./row_menu.js";
import { RowList } from "./rows.js";
import { sampleText } from "./samples.js";

import "./vpl.css";

/** @typedef {import("../../program_tab/tab.js").Parts} Parts */
/** @typedef {import("../../hosts/program_host.js").ProgramView} ProgramView */
/** @typedef {import("./place.js").Spot} Spot */

const TEXT_KEY = "vpl.text";
/** Lower windows have no room for the text until it is asked for. */
const ROOMY = "(min-width: 1181px) and (min-height: 720px)";

/** @implements {ProgramView} */
class VplView {
  /** @type {Spot | null} the block whose editor is open */ #edited = null;
  #lastEvent = 0;
  #announced = "";
  #isAsked = false;

  /** @param {Parts} parts */
  constructor(parts) {
    const { context, session, redraw } = parts;
    const t = translator(context.language, TEXTS);
    this.parts = parts;
    this.t = t;
    this.editing = new VplEditing({ workspace: session.workspace, kept: session.texts });

    this.rows = new RowList({ t });
    this.commands = new VplCommands({
      t,
      editing: this.editing,
      rows: this.rows,
      say: (text, kind) => this.report(text, kind),
      announce: context.announce,
      redraw,
      draw: () => this.redraw(),
    });
    const { editing, commands, rows } = this;
    /** @param {string} name @param {boolean} isKey */
    const add = (name, isKey) => commands.add(name, isKey);
    this.events = palette({ t, types: ["event", "condition"], add });
    this.actions = palette({ t, types: ["action"], add });
    /** @param {(spot: Spot) => void} act */
    const onEdited = (act) => this.#edited && act(this.#edited);
    this.sheet = new BlockSheet({
      t,
      change: (block, series) =>
        onEdited((spot) => commands.edit(changeBlock(editing.program, placeOf(spot), block), series)),
      endSeries: () => editing.endSeries(),
      copy: () => onEdited((spot) => commands.copy(spot)),
      remove: () => onEdited((spot) => commands.remove(spot)),
      closed: () => this.#sheetClosed(),
    });
    this.menu = rowMenu({ t, act: (verb, row) => commands.actOnRow(verb, row) });
    this.notices = noticeList();
    this.pane = textPane({
      t: parts.t,
      empty: t("pane.empty"),
      turn: () => void parts.commands.detach(),
      choose: (line) => commands.select(editing.rowOf(line + 1)),
    });
    this.status = h("p", { class: "vpl-status", hidden: true });
    this.controls = vplBar({
      t,
      undo: () => commands.undo(),
      redo: () => commands.redo(),
      choose: (mode) => this.#chooseMode(mode),
      toggleText: () => this.#toggleText(),
    });
    this.bar = this.controls.element;
    this.entries = [
      h(
        "button",
        { type: "button", class: "btn", "data-verb": "blocks", onclick: () => this.#showAsBlocks() },
        icon("blocks", { small: true }),
        h("span", { class: "grow" }, t("blocks.show")),
      ),
    ];
    this.element = h(
      "div",
      { class: "vpl" },
      this.events.element,
      h("div", { class: "vpl-program" }, this.notices.element, rows.element, this.status, this.pane.element),
      this.actions.element,
      this.sheet.element,
      this.menu.element,
    );
    rows.element.addEventListener("click", (event) => this.#click(event));
    rows.element.addEventListener("focusin", ({ target }) => this.#focused(target));
    watchKeys(this.element, rows, commands);
    this.endDrags = dragBlocks({
      element: this.element,
      rows: rows.element,
      commands,
      started: () => this.sheet.close(),
    });
  }

  show() {
    this.sheet.close();
    this.commands.forget();
    this.editing.open();
    this.#lastEvent = this.parts.session.state.log.at(-1)?.id ?? 0;
    this.report("", "good");
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
    setText(this.status, text);
    this.status.dataset.kind = kind;
    this.status.hidden = text === "";
    if (text !== "") this.parts.context.announce(text);
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
    const { editing, commands, t } = this;
    const { session, context } = this.parts;
    const { program, selected, canUndo, canRedo } = editing;
    const { mode } = program;
    const modes = offeredModes(session.toolbox);
    const isTextShown = this.#isTextShown;
    this.controls.render({ canUndo, canRedo, modes, mode, isTextShown });
    this.events.render(session.toolbox, mode);
    this.actions.render(session.toolbox, mode);
    const refusal = editing.question === null ? editing.refusal : null;
    this.rows.render({ program, refusal, selected, slot: commands.slot, isPasting: commands.isPasting });
    this.#showNotices();
    const about = selected === null ? "" : t("pane.marked", { row: selected + 1 });
    this.pane.render({ isShown: isTextShown, text: editing.shown.text, selected: editing.selectedLines, about });
    if (this.#edited !== null) {
      const button = this.rows.element.querySelector(`[data-place="${written(this.#edited)}"]`);
      this.sheet.update(blockAt(program, placeOf(this.#edited)), mode, button);
    }
    const announced = refusal === null || refusal.hint ? "" : t(refusal.key, refusal.values);
    if (announced !== this.#announced && announced !== "") context.announce(announced);
    this.#announced = announced;
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
    const { editing, commands, t } = this;
    const { redraw } = this.parts;
    const shown = questionNotices({
      t,
      editing,
      wanted: commands.wanted,
      decide: (isRenewed) => (editing.decide(isRenewed), redraw()),
      read: () => (editing.forgetWarnings(), redraw()),
      answer: (isYes) => commands.changeMode(isYes),
      turn: () => void this.parts.commands.detach(),
    });
    for (const [id, notice] of Object.entries(shown)) this.notices.set(id, notice);
    const isAsked = editing.question?.isAsked ?? false;
    if (isAsked && !this.#isAsked) this.notices.focus("question");
    this.#isAsked = isAsked;
  }

  /** Whether the text is shown: as it was chosen, else if there is room. */
  get #isTextShown() {
    const kept = this.parts.session.storage.getItem(TEXT_KEY);
    return kept === null ? matchMedia(ROOMY).matches : kept === "on";
  }

  /** @param {import("../kinds.js").Mode} mode */
  #chooseMode(mode) {
    if (!this.commands.chooseMode(mode)) return;
    this.redraw();
    this.notices.focus("loss");
  }

  /** The program as blocks, which is a new program: blocks cannot become rows again. */
  async #showAsBlocks() {
    const { editing, t } = this;
    /** @type {HTMLElement | null} */ (this.entries[0].closest("[popover]"))?.hidePopover();
    if (editing.isBlocked) return this.showMistake();
    const { commands, session, context } = this.parts;
    const module = await import("../../blockly/as_blocks.js").catch(() => null);
    if (module === null) return this.report(context.text("page")("app.notLoaded"), "error");
    const { text, unknown } = module.asBlocks(editing.shown.text);
    if (text === null) return this.report(t("blocks.unknown", { ...unknown }), "error");
    const { name } = session.workspace.current;
    commands.beginFromThis(text);
    context.announce(t("blocks.shown", { name }));
  }

  #toggleText() {
    trySetItem(this.parts.session.storage, TEXT_KEY, this.#isTextShown ? "off" : "on");
    this.parts.redraw();
  }

  /** @param {EventTarget | null} target */
  #focused(target) {
    const spot = spotOf(target);
    if (spot === null) return;
    this.rows.setCurrent(written(spot));
    if (spot.row !== this.editing.selected) this.commands.select(spot.row);
  }

  /** @param {MouseEvent} event */
  #click({ target, detail }) {
    const { editing, commands, t } = this;
    const spot = spotOf(target);
    if (spot === null) {
      const row = target instanceof Element ? target.closest("[data-row]") : null;
      if (row instanceof HTMLElement) commands.select(Number(row.dataset.row));
      return;
    }
    const button = /** @type {HTMLElement} */ (/** @type {Element} */ (target).closest("[data-place]"));
    if (spot.slot === "row") return this.menu.open(spot.row, editing.program.rows.length - 1, button);
    if (!isSlot(spot)) return commands.remove(spot);
    const block = blockAt(editing.program, placeOf(spot));
    if (block !== null) {
      commands.select(spot.row);
      this.#edited = spot;
      return this.sheet.open(block, editing.mode, button);
    }
    if (commands.isPasting) return commands.paste(spot);
    const { row, slot } = spot;
    const isOff = editing.selected === row && commands.slot === slot;
    commands.select(row, isOff ? null : slot);
    this.report(isOff ? "" : t(`slot.choose.${slot}`), "good");
    if (detail === 0 && !isOff) (slot === "actions" ? this.actions : this.events).focus();
  }

  #sheetClosed() {
    const edited = this.#edited;
    this.#edited = null;
    if (edited !== null && document.activeElement === document.body) this.rows.focus(written(edited));
  }
}

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new VplView(parts);
}

export { sampleText, withoutVpl as withoutPicture };
