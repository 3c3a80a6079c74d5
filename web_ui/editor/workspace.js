// The open programs, one per tab: which robot runs which, and the drafts in browser storage. No DOM.

import { isPython } from "../browser/python_name.js";
import { AeslError, readAesl } from "./aesl.js";
import {
  blank,
  codeOf,
  edited,
  fileName,
  fromRobot,
  isInRobot,
  isUnsaved,
  opened,
  redefined,
  rewritten,
} from "./documents.js";

/** @typedef {import("./documents.js").Document} Document */
/** @typedef {import("./state.js").ProgramInfo} ProgramInfo */
/** @typedef {{ name: string, line: number, column: number, what: string }} Refusal */

/** The tab of the program for all robots; other tabs are named after their robot. */
export const ALL = "*";
/** What a file has that is none of Aseba. */
const NO_FILE = readAesl("<network/>");

export class Workspace {
  /**
   * @param {object} options
   * @param {import("./file_store.js").FileStore} options.fileStore
   * @param {() => number} options.now      milliseconds since 1970
   * @param {() => void} options.changed    called when another text must be shown
   * @param {(text: string) => void} [options.written]   called when the user has written a text
   * @param {() => void} [options.offered]   called when there is another draft, or none, to offer
   */
  constructor({ fileStore, now, changed, written = () => {}, offered = () => {} }) {
    this.fileStore = fileStore;
    this.now = now;
    this.changed = changed;
    this.written = written;
    this.offered = offered;
    this.tab = ALL;
    /** @type {Map<string, Document>} */ this.documents = new Map();
    /** @type {import("./aesl.js").Aesl | null} */ this.parsed = null;
    /** @type {Map<string, import("./file_store.js").StoredFile>} */ this.drafts = new Map();
    /** @type {Map<string, import("./file_store.js").StoredFile>} */ this.discarded = new Map(); // drafts, by tab
    /** @type {Set<string>} */ this.following = new Set(); // tabs that take the robot's program whatever they hold
  }

  /** @returns {Document} */
  get current() {
    return this.at(this.tab);
  }

  /** Whether the robot runs exactly the current text. */
  get isInRobot() {
    return isInRobot(this.current);
  }

  /** The parsed file of the current text; without nodes for one in Python. */
  get file() {
    const { name, text } = this.current;
    if (isPython(name)) return NO_FILE;
    if (this.parsed?.text !== text) this.parsed = readAesl(text);
    return this.parsed;
  }

  /** Convert a line of the file to a line of the code that is shown. @param {number} line */
  codeLine(line) {
    const [unit] = this.file.nodes[this.current.node]?.units ?? [];
    const before = unit === undefined ? 1 : this.current.text.slice(0, unit.from).split("\n").length;
    return Math.max(line - before + 1, 1);
  }

  /** @param {string} tab @returns {Document} */
  at(tab) {
    const known = this.documents.get(tab);
    if (known !== undefined) return known;
    const document = blank(tab === ALL ? undefined : fileName(tab));
    this.documents.set(tab, document);
    this.#offerDraft(tab);
    return document;
  }

  /** @param {string} tab */
  #offerDraft(tab) {
    this.fileStore.whenLeft(tab, (draft) => {
      this.drafts.set(tab, draft);
      this.offered();
    });
  }

  /**
   * Another page has changed the storage: a draft that it continues or has removed is not offered any more.
   *
   * @param {string | null} key
   */
  storageChanged(key) {
    for (const tab of [...this.drafts.keys()].filter((each) => this.fileStore.isOfDraft(each, key))) {
      this.drafts.delete(tab);
      this.#offerDraft(tab);
      this.offered();
    }
  }

  /** @param {string} tab */
  choose(tab) {
    if (tab === this.tab) return;
    this.at(tab);
    this.tab = tab;
    this.changed();
  }

  /** @param {number} node */
  chooseNode(node) {
    this.documents.set(this.tab, { ...this.current, node });
    this.changed();
  }

  /**
   * Begin with a program of the page, which needs no place among the last programs. Its name is the title, with a number
   * if another program has this name.
   *
   * @param {string} title
   * @param {string} [text]  "" is an empty page
   */
  begin(title, text = "") {
    const name = this.#freeName(title);
    this.#replace(this.tab, text === "" ? { ...blank(name), own: true } : opened(name, text));
  }

  /**
   * Show a program that is kept elsewhere, such as that of a mission, under this name.
   *
   * @param {string} title
   * @param {string} text
   */
  show(title, text) {
    const name = fileName(title);
    const { current } = this;
    const document = text === "" ? { ...blank(name), own: true } : opened(name, text);
    if (current.name !== name || current.text !== document.text) this.#replace(this.tab, document);
    else if (!current.own) this.#replace(this.tab, { ...current, own: true }); // the robot has it from an earlier visit
  }

  /** @param {string} title */
  #freeName(title) {
    const kept = [...this.fileStore.recent(), ...this.drafts.values()];
    const open = [...this.documents].filter(([tab, document]) => tab !== this.tab || isUnsaved(document));
    const taken = new Set([...kept, ...open.map(([, document]) => document)].map(({ name }) => name.toLowerCase()));
    const [, base, ending] = /** @type {RegExpExecArray} */ (/^(.*)(\.\w+)$/.exec(fileName(title)));
    let name = base + ending;
    for (let number = 2; taken.has(name.toLowerCase()); number++) name = `${base} ${number}${ending}`;
    return name;
  }

  /**
   * Open a file; nothing changes if it is rejected.
   *
   * @param {string} name
   * @param {string} text
   * @returns {Refusal | null}
   */
  open(name, text) {
    return this.#accept(name, () => {
      this.#replace(this.tab, opened(fileName(name), text));
      this.fileStore.addRecent({ name: fileName(name), text, time: this.now() });
    });
  }

  /**
   * Open a program from elsewhere beside what there is: a name that is taken gets a number, and the open program is kept
   * among the last ones if only the robot has it. Nothing changes if it is rejected.
   *
   * @param {string} name
   * @param {string} text
   * @param {boolean} isBuiltIn  whether the open program is one of the robot's own, which need not be kept
   * @returns {Refusal | null}
   */
  openBeside(name, text, isBuiltIn) {
    return this.#accept(name, () => {
      const document = opened(this.#freeName(name), text);
      const { source } = this.current;
      if (source !== null && !isBuiltIn && !isUnsaved(this.current)) this.keep();
      this.#replace(this.tab, document);
    });
  }

  /** @param {string} name @param {() => void} act @returns {Refusal | null} */
  #accept(name, act) {
    try {
      act();
      return null;
    } catch (error) {
      if (!(error instanceof AeslError)) throw error;
      return { name, line: error.line, column: error.column, what: error.message };
    }
  }

  /** Set the code of the shown text. @param {string} code */
  edit(code) {
    this.#set(edited(this.current, code));
  }

  /** Set the whole file as one edit: for a language that owns more than the code. @param {string} text */
  replaceText(text) {
    this.#set(rewritten(this.current, text));
  }

  /** Keep the current text among the last programs: something is about to be removed from it. */
  keep() {
    const { name, text } = this.current;
    this.fileStore.addRecent({ name, text, time: this.now(), unsaved: true });
  }

  /** @param {"event" | "constant"} kind @param {string} name @param {number | null} value */
  define(kind, name, value) {
    this.#set(redefined(this.current, kind, name, value));
  }

  /** @param {string} name */
  rename(name) {
    const { current } = this;
    const isSame = isPython(name) === isPython(current.name);
    this.#set({ ...current, name: fileName(isSame ? name : `${name}${isPython(current.name) ? ".py" : ".aesl"}`) });
  }

  saved() {
    const document = this.current;
    this.fileStore.addRecent({ name: document.name, text: document.text, time: this.now() });
    this.#set({ ...document, saved: document.text });
  }

  /** The robot accepted this text. @param {string} tab @param {string} text */
  loaded(tab, text) {
    this.documents.set(tab, { ...this.at(tab), loaded: text, source: text });
  }

  /** Show the program that the robot has, whatever the tab contains. */
  follow() {
    this.following.add(this.tab);
  }

  /**
   * Update the program that a robot runs. It is shown if no user changes would be lost.
   *
   * @param {string} tab
   * @param {ProgramInfo | null | undefined} program
   */
  setRobotProgram(tab, program) {
    if (!program?.file) return;
    const document = this.at(tab);
    if (program.foreign === true) {
      // It has no text that could be edited: what is shown stays, and is not in the robot any more.
      if (document.loaded !== null) this.documents.set(tab, { ...document, loaded: null, source: null });
      return;
    }
    if (document.loaded === null && program.file === document.text) return this.loaded(tab, document.text);
    const isWanted = this.following.has(tab);
    if (program.file === document.source && !isWanted) return;
    const untouched = isInRobot(document) || (!document.own && !isUnsaved(document));
    if (!untouched && !isWanted) return;
    this.following.delete(tab);
    try {
      this.#replace(tab, fromRobot(program));
    } catch (error) {
      if (!(error instanceof AeslError)) throw error; // the runtime accepts more than this parser; keep the open text
    }
  }

  /** The draft of this tab from an earlier visit. */
  get draft() {
    const draft = this.drafts.get(this.tab);
    return draft === undefined || draft.text === this.current.text ? null : draft;
  }

  restoreDraft() {
    const draft = this.drafts.get(this.tab);
    if (draft === undefined) return;
    this.drafts.delete(this.tab);
    this.fileStore.adoptDraft(this.tab, draft);
    this.restore(draft);
  }

  /** Continue with a text that is not in a file. @param {import("./file_store.js").StoredFile} kept */
  restore({ name, text }) {
    const { text: saved } = blank();
    this.#replace(this.tab, { ...opened(name, text), saved });
  }

  /** Discard the draft; until something is written, it can be brought back. */
  forgetDraft() {
    const draft = this.drafts.get(this.tab);
    if (draft === undefined) return;
    this.drafts.delete(this.tab);
    this.fileStore.adoptDraft(this.tab, draft);
    this.fileStore.storeDraft(this.tab, null);
    this.discarded.set(this.tab, draft);
  }

  /** Bring a discarded draft back. */
  undoForget() {
    const draft = this.discarded.get(this.tab);
    if (draft === undefined) return;
    this.settleForget();
    this.drafts.set(this.tab, draft);
    this.fileStore.storeDraft(this.tab, draft);
  }

  /** No longer offer to bring it back. */
  settleForget() {
    this.discarded.delete(this.tab);
  }

  /** @returns {string} */
  get code() {
    return codeOf(this.current);
  }

  /** @param {Document} document */
  #set(document) {
    this.documents.set(this.tab, document);
    const { name, text } = document;
    this.drafts.delete(this.tab);
    this.settleForget();
    this.fileStore.storeDraft(this.tab, isUnsaved(document) ? { name, text, time: this.now() } : null);
    if (isUnsaved(document)) this.written(text);
  }

  /**
   * Replace the document of a tab; unsaved text is added to the recent files.
   *
   * @param {string} tab
   * @param {Document} document
   */
  #replace(tab, document) {
    const old = this.documents.get(tab);
    if (old !== undefined && isUnsaved(old)) {
      this.fileStore.addRecent({ name: old.name, text: old.text, time: this.now(), unsaved: true });
    }
    this.documents.set(tab, document);
    if (tab === this.tab) this.changed();
    if (isUnsaved(document)) this.written(document.text);
  }
}
