// Programs of blocks: a view of the open document (hosts/program_host.js).
//
//   BlocksDocument   the file as blocks and text
//   BlocksField      Blockly
//   ProgramChecker   the compiler's verdict on the text
//   blocksBar, fileNotice, textPanel, blocksFoot   what is around the blocks

import { localStore, trySetItem } from "../../browser/local_storage.js";
import { ProgramChecker } from "../../editor/program_checker.js";
import WORDS from "../../i18n/blockly.texts.js";
import { translator } from "../../i18n/index.js";
import { disabledReason } from "../../state/disabled_reason.js";
import { faultMessage, lineOf } from "../../state/program_status.js";
import { h, setAttribute } from "../../ui/dom.js";
import { withoutBlocks } from "../file.js";
import { importFile as importBlocks } from "../import.js";
import { lookOf, offeredLooks } from "../looks.js";
import { isEmpty } from "../state.js";
import { blocksBar } from "./bar.js";
import { BlocksField } from "./blocks_field.js";
import { ask } from "./dialogs.js";
import { BlocksDocument } from "./document.js";
import { blocksFoot } from "./foot.js";
import { lookChoice } from "./look_choice.js";
import { blockMistakes, summary } from "./mistakes.js";
import { fileNotice } from "./notice.js";
import { textPanel } from "./text_panel.js";

import "./blocks.css";

export { sampleText } from "../samples/index.js";
export { withoutBlocks as withoutPicture };

/** @typedef {import("../../program_tab/tab.js").Parts} Parts */
/** @typedef {import("../../hosts/program_host.js").ProgramView} ProgramView */
/** @typedef {import("../toolbox.js").Look} Look */

const LOOK_KEY = "program.look";
const TEXT_KEY = "program.blocksText";

/** @implements {ProgramView} */
class BlocksView {
  /** @type {BlocksDocument} */ #document;
  /** The look of blocks that the user has chosen for the open document. @type {Look | null} */ #chosen = null;
  /** @type {import("../../program_tab/toolbox_file.js").Toolbox | null} */ #toolbox = null;
  /** @type {import("./mistakes.js").BlockMistake[]} */ #mistakes = [];
  /** @type {string | null} the selected block */ #selected = null;
  /** What the running program failed with. */ #fault = "";
  /** The block in which it failed. @type {string | null} */ #faulty = null;
  /** Whether the compiler has seen the program. */ #isChecked = false;
  #isTextShown = localStore.getItem(TEXT_KEY) === "true";
  /** Whether Blockly shows the document. */ #isLoaded = false;
  #isAsking = false;
  #isDestroyed = false;

  /** @param {Parts} parts */
  constructor(parts) {
    const { t: editorText, context, session, commands, redraw } = parts;
    const { language } = context;
    const t = translator(language, WORDS);
    this.parts = parts;
    this.t = t;
    this.#document = new BlocksDocument(session.workspace.current.text);
    this.place = h("div", { class: "blocks-place" });
    this.hint = h("p", { class: "blocks-hint", hidden: true }, t("view.empty"));
    this.field = new BlocksField({
      place: this.place,
      t,
      language,
      changed: () => this.#changed(),
      selected: (id) => {
        this.#selected = id;
        redraw();
      },
    });
    this.checker = new ProgramChecker({
      language,
      runtime: context.actions.runtime,
      workspace: session.workspace,
      found: ({ verdict }) => {
        this.#isChecked = verdict !== null;
        this.#showMistakes();
        redraw();
      },
    });
    this.notice = fileNotice({ t, adopt: () => this.#adopt() });
    this.panel = textPanel({
      t,
      turnText: editorText("detach.turn"),
      turn: () => void commands.detach(),
      choose: (line) => {
        const id = this.#document.blocks[line];
        if (id) this.field.select(id);
      },
    });
    this.foot = blocksFoot(() => this.showMistake());
    const bar = blocksBar({
      t,
      editorText,
      commands,
      undo: (again) => this.field.undo(again),
      toggleText: () => {
        this.#isTextShown = !this.#isTextShown;
        trySetItem(localStore, TEXT_KEY, String(this.#isTextShown));
        redraw();
      },
    });
    context.theme.subscribe(redraw);
    this.controls = bar;
    this.bar = bar.element;
    this.looks = lookChoice({ t, choose: (look) => this.#chooseLook(look) });
    this.entries = [this.looks.element];
    this.element = h(
      "div",
      { class: "blocks" },
      this.notice.element,
      h("div", { class: "blocks-body" }, h("div", { class: "blocks-frame" }, this.place, this.hint), this.panel.element),
      this.foot.element,
    );
  }

  show() {
    const { current } = this.parts.session.workspace;
    if (this.#isLoaded && current.text === this.#document.text) return;
    this.#document = new BlocksDocument(current.text);
    const { node } = this.#document.file;
    this.#chosen = null;
    this.#selected = null;
    this.#isLoaded = false;
    if (this.#document.canEdit && node !== current.node) return this.parts.session.workspace.chooseNode(node); // shows
    this.checker.restart();
    void this.#fill();
  }

  resized() {
    this.field.resize();
  }

  hasMistake() {
    return this.#mistakes.some(({ isError }) => isError);
  }

  showMistake() {
    const [first] = this.#mistakes;
    if (first?.id) this.field.reveal(first.id);
    if (first !== undefined) this.parts.context.announce(first.text);
  }

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  report(text, kind) {
    this.foot.report(text, kind);
  }

  async loaded() {}

  focus() {
    this.field.focus();
  }

  destroy() {
    this.#isDestroyed = true;
    this.checker.destroy();
    this.field.destroy();
    this.bar.remove();
    this.element.remove();
  }

  redraw() {
    const { session, selection, context } = this.parts;
    const { state } = context.store;
    this.checker.retry(state.services);
    this.#offer();
    setAttribute(this.place, "data-dark", String(context.theme.isDark));
    const values = selection.status?.values ?? {};
    const isRunning = selection.isTextRunning;
    this.controls.render({
      reason: disabledReason(state, context.text("page")),
      state: values.state ?? "",
      canUndo: this.field.canUndo,
      canRedo: this.field.canRedo,
      isTextShown: this.#isTextShown,
    });
    const line = isRunning && ["paused", "fault"].includes(values.state ?? "") ? lineOf(values) : 0;
    const running = line > 0 ? (this.#document.blocks[line - 1] ?? null) : null;
    if (this.#isLoaded) this.field.highlight(running);
    const fault = isRunning && values.state === "fault" ? faultMessage(values, context.language) : "";
    if (fault !== this.#fault) {
      this.#fault = fault;
      this.#faulty = running;
      this.#showMistakes();
    }
    this.panel.element.hidden = !this.#isTextShown;
    if (this.#isTextShown) {
      const selected = this.#selected === null ? null : this.#document.linesOf(this.#selected);
      this.panel.render({ program: session.workspace.code, selected, running: line > 0 ? line - 1 : null });
    }
    this.hint.hidden = !this.#isLoaded || !isEmpty(this.#document.state);
  }

  /** Show the document in Blockly, once that is there. */
  async #fill() {
    await this.field.ready;
    if (this.#isDestroyed || this.#isLoaded || !this.element.isConnected) return;
    const document = this.#document;
    const look = this.#lookNow();
    if (this.field.look !== look) this.field.open(look, this.#hidden());
    this.field.load(document.canEdit ? document.state : {});
    if (document.canEdit) document.loaded(this.field.state);
    this.#isLoaded = true;
    setAttribute(this.place, "data-known", String(document.canEdit));
    const { imported, workspace } = this.parts.session;
    this.notice.render(document, imported?.text === workspace.current.text ? imported.leftOut : []);
    this.#showLooks();
    this.#showMistakes();
    this.parts.redraw();
  }

  #lookNow() {
    const looks = offeredLooks(this.parts.session.toolbox);
    const kept = looks.find((look) => look === localStore.getItem(LOOK_KEY));
    return this.#chosen ?? lookOf(this.#document.state) ?? kept ?? looks[0];
  }

  /** @param {Look} look */
  #chooseLook(look) {
    if (look === this.field.look) return;
    this.#chosen = look;
    trySetItem(localStore, LOOK_KEY, look);
    this.#isLoaded = false;
    void this.#fill();
  }

  #showLooks() {
    this.looks.render(offeredLooks(this.parts.session.toolbox), this.field.look);
  }

  /** Offer what a teacher's file leaves. */
  #offer() {
    const { toolbox } = this.parts.session;
    if (toolbox === this.#toolbox) return;
    const isFirst = this.#toolbox === null;
    this.#toolbox = toolbox;
    if (isFirst || this.field.look === null) return;
    this.field.offer(this.#hidden());
    this.#showLooks();
  }

  #hidden() {
    return new Set(this.parts.session.toolbox.hide);
  }

  /** Blocks were changed. */
  #changed() {
    if (!this.#isLoaded || this.field.isDragging || !this.#document.canEdit) return;
    const { state } = this.field;
    if (this.#document.isSame(state)) return this.parts.redraw();
    if (this.#document.isOther) return void this.#decide(state);
    this.#write(() => this.#document.change(state));
  }

  /**
   * The program of the file is another one: ask before it is replaced by that of changed blocks.
   *
   * @param {import("../state.js").WorkspaceState} state
   */
  async #decide(state) {
    if (this.#isAsking) return;
    this.#isAsking = true;
    const { t } = this;
    const answer = await ask({ t, question: t("view.ask"), yes: t("view.ask.yes"), no: t("view.ask.no") });
    this.#isAsking = false;
    if (this.#isDestroyed) return;
    if (answer === null) return this.field.undo();
    this.#write(() => {
      this.#document.change(state);
      return this.#document.adopt();
    });
  }

  /** Make the text from the blocks, as they are. */
  #adopt() {
    this.#write(() => this.#document.adopt());
  }

  /** Set the text of the file. What only the old one has is kept among the last programs. @param {() => string} change */
  #write(change) {
    const { workspace } = this.parts.session;
    if (this.#document.hasOwnText) workspace.keep();
    workspace.replaceText(change());
    this.notice.render(this.#document, []);
    this.#showMistakes();
    this.checker.checkSoon();
    this.parts.redraw();
  }

  #showMistakes() {
    const { t, parts } = this;
    const { t: editorText } = parts;
    const verdict = this.checker.verdict;
    const before = this.#mistakes.map(({ text }) => text).join();
    this.#mistakes = blockMistakes(this.#document, verdict, t);
    const fault = this.#fault === "" ? [] : [{ id: this.#faulty, text: t("view.fault", { text: this.#fault }) }];
    if (this.#isLoaded) this.field.mark([...this.#mistakes, ...fault]);
    const words = summary(this.#mistakes, t) || (fault[0]?.text ?? "");
    if (words === "") this.foot.report(this.#isChecked ? editorText("mistakes.none") : "", this.#isChecked ? "good" : "");
    else this.foot.report(words, this.hasMistake() || fault.length > 0 ? "error" : "warning");
    if (words !== "" && this.#mistakes.map(({ text }) => text).join() !== before) parts.context.announce(words);
  }
}

/** Open a file of another program. @param {Uint8Array} bytes @param {string} language */
export const importFile = (bytes, language) => importBlocks(bytes, translator(language, WORDS));

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new BlocksView(parts);
}
