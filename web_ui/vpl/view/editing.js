// The VPL program that is edited: the file, its undo history, what is selected, and whether its text is still the stored
// one. Every edit becomes the text of the document (editor/workspace.js), which is the only truth. No DOM.

import { compareText } from "../compare.js";
import { VplError } from "../errors.js";
import { newVpl, readVpl, writeVpl } from "../file.js";
import { generate, rowOfLine } from "../generator.js";
import { endSeries, newHistory, record, redo, undo } from "../history.js";
import { lostIn, withMode } from "../mode.js";
import { makeProgram, sameProgram } from "../program.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../compare.js").Comparison} Comparison */
/** @typedef {import("../file.js").VplFile} VplFile */
/** @typedef {import("../generator.js").Source} Source */
/** @typedef {import("../history.js").History} History */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {import("../program.js").Finding} Finding */
/** @typedef {import("../program.js").Program} Program */
/**
 * What the view knows of a document, as long as its text stays.
 *
 * @typedef {object} Opened
 * @property {string} text             of the document now
 * @property {VplFile} file            as it was opened
 * @property {Comparison} comparison   of its text with its blocks
 * @property {History} history
 * @property {boolean} isStored        whether the text is still the one of the file: no decision to renew it was made
 * @property {boolean} isRenewed       whether the user wants a new text even for the blocks of the file
 * @property {string} code             the last text without error
 * @property {boolean} areWarningsRead
 */

/** Where the text of a file is not that of its blocks, the user decides which one counts. */
const UNDECIDED = ["older", "edited", "broken"];

export class VplEditing {
  /** @type {Opened} */ #opened;
  /** @type {{ program: Program | null, result: ReturnType<typeof generate> }} */
  #last = { program: null, result: generate(makeProgram("basic")) };
  /** @type {{ program: Program, series: string } | null} an edit that waits for the decision */ #pending = null;
  /** @type {VplError | null} */ error = null;
  /** @type {number | null} the row that blocks of the palette go to */ selected = null;

  /**
   * @param {object} options
   * @param {import("../../editor/workspace.js").Workspace} options.workspace
   * @param {Map<string, any>} options.kept   outlives the view
   */
  constructor({ workspace, kept }) {
    this.workspace = workspace;
    this.kept = kept;
    this.#opened = fresh(newVpl());
  }

  /** Read the document: another one is open. */
  open() {
    const { text } = this.workspace.current;
    const known = /** @type {Opened | undefined} */ (this.kept.get(this.#key));
    this.error = this.#pending = this.selected = null;
    try {
      this.#opened = known?.text === text ? known : fresh(text);
      this.kept.set(this.#key, this.#opened);
    } catch (error) {
      if (!(error instanceof VplError)) throw error;
      this.error = error;
      this.#opened = fresh(newVpl());
      return;
    }
    if (this.#opened.comparison.origin === "empty" && this.error === null) this.#write();
  }

  /** The text of the program; made once for each program. */
  get #generated() {
    const { program } = this;
    if (this.#last.program !== program) this.#last = { program, result: generate(program) };
    return this.#last.result;
  }

  get #key() {
    const { tab, current } = this.workspace;
    return `vpl ${tab} ${current.name}`;
  }

  get program() {
    return this.#opened.history.present;
  }

  get mode() {
    return this.program.mode;
  }

  /** The first error of the blocks; null: they can run. */
  get refusal() {
    return this.#generated.refusal;
  }

  /** Whether nothing can run: the blocks have an error, and there is no stored text that counts instead. */
  get isBlocked() {
    return !this.#opened.isStored && this.refusal !== null;
  }

  get canUndo() {
    return this.#opened.history.past.length > 0;
  }

  get canRedo() {
    return this.#opened.history.future.length > 0;
  }

  /** What could not be read as it is written; empty once it was read. */
  get warnings() {
    return this.#opened.areWarningsRead ? [] : this.#opened.file.warnings;
  }

  forgetWarnings() {
    this.#opened.areWarningsRead = true;
  }

  /**
   * The question whether the stored text or the blocks count; null if there is none.
   *
   * @returns {{ message: Finding, changes: readonly Finding[], isAsked: boolean } | null}  isAsked: an edit waits for it
   */
  get question() {
    const { comparison, isStored } = this.#opened;
    if (!isStored) return null;
    return { message: comparison.message, changes: comparison.changes, isAsked: this.#pending !== null };
  }

  /**
   * The text of the document, with the lines of its rows if they are known.
   *
   * @returns {{ text: string, source: Source | null }}
   */
  get shown() {
    const { comparison, isStored, file, code } = this.#opened;
    if (isStored) return { text: file.code, source: comparison.source };
    const { source } = this.#generated;
    // Files have blanks after the text, in front of the blocks.
    return { text: code, source: source?.text.trimEnd() === code.trimEnd() ? source : null };
  }

  /** The lines of the selected row in that text, from 0. */
  get selectedLines() {
    const rows = this.shown.source?.rows ?? [];
    const lines = this.selected === null ? null : (rows[this.selected] ?? null);
    return lines === null ? null : { first: lines.first - 1, last: lines.last - 1 };
  }

  /** The row that a line of the text belongs to. @param {number} line  from 1 */
  rowOf(line) {
    const { source } = this.shown;
    return source === null ? null : rowOfLine(source, line);
  }

  /**
   * Make an edit. If the text of the file is not that of its blocks, it waits until the user has decided.
   *
   * @param {Program} next
   * @param {string} [series]   consecutive edits of one gesture are undone together
   */
  edit(next, series = "") {
    if (next === this.program || this.error !== null) return; // there is no file that could take it
    if (this.#opened.isStored) {
      this.#pending = { program: next, series };
      return;
    }
    this.#opened.history = record(this.#opened.history, next, series);
    this.#write();
  }

  /** The gesture of the last edits is over. */
  endSeries() {
    this.#opened.history = endSeries(this.#opened.history);
  }

  /**
   * Decide: a new text is made from the blocks, with the edit that waits; else the stored text stays.
   *
   * @param {boolean} isRenewed
   */
  decide(isRenewed) {
    const pending = this.#pending;
    this.#pending = null;
    if (!isRenewed) return;
    this.#opened.isStored = false;
    this.#opened.isRenewed = true;
    if (pending === null) return this.#write();
    this.edit(pending.program, pending.series);
  }

  undo() {
    this.#opened.history = undo(this.#opened.history);
    this.#write();
  }

  redo() {
    this.#opened.history = redo(this.#opened.history);
    this.#write();
  }

  /** What the program loses in a mode. @param {Mode} mode */
  lostIn(mode) {
    return lostIn(this.program, mode);
  }

  /** @param {Mode} mode */
  setMode(mode) {
    this.edit(withMode(this.program, mode));
  }

  #write() {
    const opened = this.#opened;
    const { file } = opened;
    const { source } = this.#generated;
    const isAsOpened = !opened.isRenewed && sameProgram(this.program, file.program) && file.code.trim() !== "";
    if (source !== null) opened.code = isAsOpened ? file.code : source.text;
    this.workspace.replaceText(writeVpl(file, this.program, opened.code));
    opened.text = this.workspace.current.text;
    if (this.selected !== null && this.selected >= this.program.rows.length) this.selected = null;
  }
}

/** @param {string} text @returns {Opened} */
function fresh(text) {
  const file = readVpl(text);
  const comparison = compareText(file);
  return {
    text,
    file,
    comparison,
    history: newHistory(file.program),
    isStored: UNDECIDED.includes(comparison.origin),
    isRenewed: false,
    code: file.code,
    areWarningsRead: false,
  };
}
