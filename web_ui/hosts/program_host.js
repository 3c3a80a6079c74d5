// Integrates the tab "Program": loads it and the chosen language on demand, and forwards messages while it is shown.
//
// One document, several views. The document (an .aesl file with all its parts, its draft, which robot has it) belongs
// to the session, in `editor/workspace.js`; it outlives views. `program_tab/tab.js` has what all languages share: run,
// stop, files, badge, new programs. A language is a view of the open document, in a module of its own.

import { localStore } from "../browser/local_storage.js";
import { CONNECTION } from "../state/index.js";

/** @typedef {import("../editor/editor_session.js").EditorSession} EditorSession */
/** @typedef {import("../program_tab/tab.js").ProgramTab} ProgramTab */
/** @typedef {import("../shell/context.js").Context} Context */
/**
 * A language's view of the open document. It edits by `session.workspace.edit(code)` and draws what the session holds.
 *
 * @typedef {object} ProgramView
 * @property {HTMLElement} element            fills the tab below the head
 * @property {HTMLElement | null} bar         controls of the language, beside the badge
 * @property {readonly HTMLElement[]} entries   of the language, in the menu of the file
 * @property {() => void} show                another document is open, or the view is on the page for the first time
 * @property {() => void} resized             the tab is shown again: sizes were not known while it was hidden
 * @property {() => void} redraw              draw; called once per frame when something changed
 * @property {() => boolean} hasMistake       whether the program cannot run as it is
 * @property {() => void} showMistake         lead the user to the first mistake
 * @property {(text: string, kind: "good" | "warning" | "error") => void} report   what became of a command
 * @property {() => Promise<void>} loaded     the robot has the document now
 * @property {() => void} focus
 * @property {() => void} destroy
 */
/** @typedef {(parts: import("../program_tab/tab.js").Parts) => ProgramView} CreateView */
/**
 * @typedef {object} Language   its name is the text `language.<id>`
 * @property {string} id
 * @property {import("../ui/icons.js").IconName} icon
 * @property {() => Promise<{ createView: CreateView }>} load
 */

/** The languages of programs, in display order. To add one: a line here. @type {readonly Language[]} */
export const LANGUAGES = [{ id: "text", icon: "text", load: () => import("../editor/index.js") }];

const TOPIC = /^\/(?:[^/]+\/)?_aseba\/(?:target|variables|events)$|^\/aseba_runtime\/_behaviours$/;

export class ProgramHost {
  /** @type {typeof import("../program_tab/tab.js") | null} */ #module = null;
  /** @type {CreateView | null} of the chosen language */ #createView = null;
  #language = LANGUAGES[0].id;
  /** @type {{ name: string, text: string } | null} opened when the tab is shown */ #kept = null;

  /**
   * @param {object} options
   * @param {HTMLElement} options.slot   the panel of the tab
   * @param {() => import("../protocol/client.js").Client} options.client
   */
  constructor({ slot, client }) {
    this.slot = slot;
    this.client = client;
    /** Whether the tab is shown. */
    this.isOpen = false;
    /** @type {EditorSession | null} */ this.session = null;
    /** @type {ProgramTab | null} stays alive while other tabs are shown */ this.tab = null;
    /** @type {Context | null} */ this.context = null;
  }

  /** Whether the tab currently needs a topic. @param {string} topic */
  wants(topic) {
    return this.isOpen && TOPIC.test(topic);
  }

  /** @param {import("../protocol/client.js").ClientEvent} event @param {string} selected  robot */
  receive(event, selected) {
    if (this.session === null || (event.type !== "message" && event.type !== "disconnected")) return;
    this.session.receive(event, selected);
    this.redraw();
  }

  redraw() {
    if (this.isOpen) this.tab?.redraw();
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.tab !== null) this.#build();
  }

  /** Show or hide the tab: call when it is opened or left. @param {boolean} visible */
  async setVisible(visible) {
    if (visible === this.isOpen) return;
    this.isOpen = visible;
    this.tab?.setShown(visible);
    if (visible) await this.#opened();
    this.client().refresh();
  }

  /** Open the tab with a program. @param {string} name @param {string} text */
  async openText(name, text) {
    (await this.#selected())?.commands.openText(name, text);
  }

  /** Open the tab with a program file. @param {File} file */
  async openFile(file) {
    void (await this.#selected())?.commands.open(file);
  }

  /** Have a program opened the next time that the tab is shown. @param {string} name @param {string} text */
  async keepText(name, text) {
    if (this.isOpen) return this.openText(name, text);
    this.#kept = { name, text };
  }

  /** Open the tab with the ways to begin: skeletons, examples, the last programs. */
  async openStart() {
    (await this.#selected())?.commands.newFile();
  }

  /** Show the open document in another language. @param {string} id */
  async chooseLanguage(id) {
    this.#language = id;
    this.#createView = null;
    if (await this.#load()) this.#setView();
  }

  async #selected() {
    this.context?.workspace.select("program");
    return this.#opened();
  }

  /** The tab; null if it cannot be loaded. @returns {Promise<ProgramTab | null>} */
  async #opened() {
    if (!(await this.#load())) return null;
    if (this.tab === null) this.#build();
    if (this.#kept !== null) this.tab?.commands.openText(this.#kept.name, this.#kept.text);
    this.#kept = null;
    return this.tab;
  }

  /** Load the modules; returns whether they are there. */
  async #load() {
    const language = LANGUAGES.find(({ id }) => id === this.#language) ?? LANGUAGES[0];
    try {
      const [tab, view] = await Promise.all([import("../program_tab/tab.js"), language.load()]);
      this.#module ??= tab;
      this.#createView ??= view.createView;
    } catch {
      const { store, text } = /** @type {Context} */ (this.context);
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return false;
    }
    this.session ??= new this.#module.EditorSession(localStore, Date.now);
    return true;
  }

  #build() {
    if (this.#module === null || this.session === null || this.context === null) return;
    this.tab?.destroy();
    this.tab = new this.#module.ProgramTab({
      session: this.session,
      context: this.context,
      languages: LANGUAGES,
      choose: (id) => void this.chooseLanguage(id),
    });
    this.slot.append(this.tab.element);
    this.tab.setShown(this.isOpen);
    this.#setView();
  }

  #setView() {
    if (this.#createView !== null) this.tab?.setView(this.#language, this.#createView);
  }
}
