// Programs of blocks: creates the objects of one view (hosts/program_host.js) and draws them.
//
//   BlocksDocument   the file as blocks and text
//   BlocksField      Blockly
//   ProgramChecker   the compiler's verdict on the text
//   blocksFrame      what is around the blocks

import { localStore, trySetItem } from "../../browser/local_storage.js";
import { ProgramChecker } from "../../editor/program_checker.js";
import WORDS from "../../i18n/blockly.texts.js";
import { translator } from "../../i18n/index.js";
import { disabledReason } from "../../state/disabled_reason.js";
import { CONNECTION } from "../../state/index.js";
import { setAttribute } from "../../ui/dom.js";
import { withoutBlocks } from "../file.js";
import { importFile as importBlocks } from "../import.js";
import { lookOf, offeredLooks } from "../looks.js";
import { isEmpty } from "../state.js";
import { BlocksField } from "./blocks_field.js";
import { ask } from "./dialogs.js";
import { BlocksDocument } from "./document.js";
import { blocksFrame } from "./frame.js";
import { blockMistakes, summary } from "./mistakes.js";
import { NOWHERE, runPlace } from "./run_place.js";

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
  /** The look that the user has chosen for the open document. @type {Look | null} */ #chosen = null;
  /** @type {import("../../editor/toolbox_file.js").Toolbox} what Blockly offers */ #toolbox;
  /** @type {import("./mistakes.js").BlockMistake[]} */ #mistakes = [];
  /** The selected block. @type {string | null} */ #selected = null;
  #place = NOWHERE;
  #isTextShown = localStore.getItem(TEXT_KEY) === "true";
  /** Whether Blockly shows the document. */ #isLoaded = false;
  /** Whether the compiler has seen the program. */ #isChecked = false;
  #isAsking = false;
  #isDestroyed = false;

  /** @param {Parts} parts */
  constructor(parts) {
    const { t: editorText, context, session, commands, redraw } = parts;
    const t = translator(context.language, WORDS);
    this.parts = parts;
    this.t = t;
    this.#document = new BlocksDocument(session.workspace.current.text);
    this.#toolbox = session.toolbox;
    const frame = blocksFrame({
      t,
      editorText,
      commands,
      undo: (again) => this.field.undo(again),
      toggleText: () => this.#toggleText(),
      adopt: () => this.#write(() => this.#document.adopt()),
      chooseLine: (line) => this.field.select(this.#document.blocks[line] ?? ""),
      chooseLook: (look) => this.#chooseLook(look),
      goToMistake: () => this.showMistake(),
    });
    this.frame = frame;
    this.element = frame.element;
    this.bar = frame.bar.element;
    this.entries = [frame.looks.element];
    this.field = new BlocksField({
      place: frame.area,
      t,
      language: context.language,
      changed: () => this.#changed(),
      selected: (id) => {
        this.#selected = id;
        redraw();
      },
    });
    this.checker = new ProgramChecker({
      language: context.language,
      runtime: context.actions.runtime,
      workspace: session.workspace,
      found: ({ verdict }) => {
        this.#isChecked = verdict !== null;
        this.#showMistakes();
        redraw();
      },
    });
    context.theme.subscribe(redraw);
  }

  show() {
    const { workspace } = this.parts.session;
    const { text, node } = workspace.current;
    if (this.#isLoaded && text === this.#document.text) return;
    this.#document = new BlocksDocument(text);
    this.#chosen = null;
    this.#selected = null;
    this.#isLoaded = false;
    const { file } = this.#document;
    if (file.hasWorkspace && file.node !== node) return workspace.chooseNode(file.node); // and this is called again
    this.checker.restart();
    void this.#fill();
  }

  resized() {
    this.field.resize();
    void this.#fill();
  }

  hasMistake() {
    return this.#mistakes.some(({ isError }) => isError);
  }

  showMistake() {
    const [first] = this.#mistakes;
    if (first === undefined) return;
    if (first.id !== null) this.field.reveal(first.id);
    this.parts.context.announce(first.text);
  }

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  report(text, kind) {
    this.frame.foot.report(text, kind);
  }

  async loaded() {}

  focus() {
    this.field.focus();
  }

  destroy() {
    this.#keep();
    this.#isDestroyed = true;
    this.checker.destroy();
    this.field.destroy();
    this.bar.remove();
    this.element.remove();
  }

  redraw() {
    const { selection, context } = this.parts;
    const { state } = context.store;
    const document = this.#document;
    this.checker.retry(state.services);
    this.#offer();
    setAttribute(this.frame.area, "data-dark", String(context.theme.isDark));
    const values = selection.status?.values ?? {};
    this.frame.bar.render({
      reason: disabledReason(state, context.text("page")),
      state: values.state ?? "",
      canUndo: this.field.canUndo,
      canRedo: this.field.canRedo,
      isTextShown: this.#isTextShown,
    });
    const before = this.#place.fault;
    this.#place = selection.isTextRunning ? runPlace(values, document.blocks, context.language) : NOWHERE;
    if (this.#isLoaded) this.field.highlight(this.#place.block);
    if (this.#place.fault !== before) this.#showMistakes();
    const selected = this.#selected === null ? null : document.linesOf(this.#selected);
    const [isShown, about] = [this.#isTextShown, this.t("view.marked")];
    this.frame.pane.render({ isShown, text: document.code, selected, about, running: this.#place.line });
    this.frame.hint.hidden = !this.#isLoaded || !document.canEdit || !isEmpty(document.state);
  }

  /** Show the document in Blockly, once that is there. */
  async #fill() {
    try {
      await this.field.ready;
    } catch {
      return this.#reportConnection();
    }
    if (this.#isDestroyed || this.#isLoaded || !this.field.isVisible) return;
    const document = this.#document;
    const { session } = this.parts;
    const { imported, toolbox } = session;
    const kept = session.blocks?.text === document.text ? session.blocks : null;
    this.#chosen ??= kept?.chosen ?? null;
    const look = this.#lookNow();
    if (this.field.look !== look) this.field.open(look, new Set(toolbox.hide));
    if (kept !== null && !kept.isOther) document.difference = null; // blocks with a mistake keep the program before it
    this.field.load(document.canEdit ? (kept?.state ?? document.state) : {}, kept?.history);
    if (document.canEdit) document.loaded(this.field.state);
    this.#isLoaded = true;
    setAttribute(this.frame.area, "data-known", String(document.canEdit));
    this.frame.notice.render(document, imported?.text === document.text ? imported.leftOut : []);
    this.frame.looks.render(offeredLooks(toolbox), look);
    this.#showMistakes();
    this.parts.redraw();
  }

  #reportConnection() {
    const { store, text } = this.parts.context;
    store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
  }

  #lookNow() {
    const looks = offeredLooks(this.parts.session.toolbox);
    const kept = looks.find((look) => look === localStore.getItem(LOOK_KEY));
    return this.#chosen ?? lookOf(this.#document.state) ?? kept ?? looks[0];
  }

  /** @param {Look} look */
  #chooseLook(look) {
    trySetItem(localStore, LOOK_KEY, look);
    this.#keep();
    this.#chosen = look;
    this.#isLoaded = false;
    this.#document = new BlocksDocument(this.#document.text);
    void this.#fill();
  }

  /** Keep what Blockly shows, and what can be undone, for another workspace with the same file. */
  #keep() {
    const { text, isOther, canEdit } = this.#document;
    if (!this.#isLoaded || !canEdit) return;
    const { state, history } = this.field;
    this.parts.session.blocks = { text, isOther, chosen: this.#chosen, state, history };
  }

  #toggleText() {
    this.#isTextShown = !this.#isTextShown;
    trySetItem(localStore, TEXT_KEY, String(this.#isTextShown));
    this.parts.redraw();
  }

  /** Offer what a teacher's file leaves, if that is another one now. */
  #offer() {
    const { toolbox } = this.parts.session;
    if (toolbox === this.#toolbox) return;
    this.#toolbox = toolbox;
    this.field.offer(new Set(toolbox.hide));
    this.frame.looks.render(offeredLooks(toolbox), this.field.look);
  }

  /** Blocks were changed. */
  #changed() {
    if (!this.#isLoaded || this.field.isDragging || !this.#document.canEdit) return;
    const { state } = this.field;
    if (this.#document.isSame(state)) this.parts.redraw();
    else if (this.#document.isOther) void this.#decide();
    else this.#write(() => this.#document.change(state));
  }

  /** The program of the file is another one: ask before that of changed blocks takes its place. */
  async #decide() {
    if (this.#isAsking) return;
    this.#isAsking = true;
    const { t } = this;
    const answer = await ask({ t, question: t("view.ask"), yes: t("view.ask.yes"), no: t("view.ask.no") });
    this.#isAsking = false;
    if (this.#isDestroyed) return;
    if (answer === null) return this.field.undo();
    this.#write(() => {
      this.#document.change(this.field.state);
      return this.#document.adopt();
    });
  }

  /** Set the text of the file; what only the old one has is kept among the last programs. @param {() => string} make */
  #write(make) {
    const { workspace } = this.parts.session;
    if (this.#document.hasOwnText) workspace.keep();
    workspace.replaceText(make());
    this.frame.notice.render(this.#document, []);
    this.#showMistakes();
    this.checker.checkSoon();
    this.parts.redraw();
  }

  #showMistakes() {
    const { t, checker, parts } = this;
    const { t: editorText } = parts;
    const before = summary(this.#mistakes, t);
    this.#mistakes = blockMistakes(this.#document, checker.verdict, t);
    const { fault, block } = this.#place;
    const faults = fault === "" ? [] : [{ id: block, text: t("view.fault", { text: fault }) }];
    if (this.#isLoaded) this.field.mark([...this.#mistakes, ...faults]);
    const words = summary(this.#mistakes, t);
    const { foot } = this.frame;
    if (words !== "") foot.report(words, this.hasMistake() ? "error" : "warning");
    else if (faults.length > 0) foot.report(faults[0].text, "error");
    else foot.report(this.#isChecked ? editorText("mistakes.none") : "", this.#isChecked ? "good" : "");
    if (words !== "" && words !== before) parts.context.announce(words);
  }
}

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new BlocksView(parts);
}

/** A file of another program as one of blocks. @param {Uint8Array} bytes @param {string} language */
export const importFile = (bytes, language) => importBlocks(bytes, translator(language, WORDS));
