// Integrates the languages of programs into the tab "Program": loads a language on demand, and forwards messages while
// the tab is shown.
//
// One document, several views of it: a language is `{ id, load }`, and `load` gives a module with a view. A view has
//
//   element           its element in the tab
//   start()           called once, when it has been added to the page
//   show()            called when the tab is shown again: sizes were unknown while it was hidden
//   redraw()          draws with the next frame
//   openText(name, text)   opens a program
//   openFile(file)    opens a program file
//   destroy()
//
// The document (the file with all its parts, its draft, which robot runs it) belongs to the session, which outlives views.

import { localStore } from "../browser/local_storage.js";
import { CONNECTION } from "../state/index.js";

/** @typedef {import("../editor/index.js").Editor} Editor */
/** @typedef {import("../editor/editor_session.js").EditorSession} EditorSession */
/** @typedef {import("../shell/context.js").Context} Context */

/** The languages of programs, in display order. */
export const LANGUAGES = /** @type {const} */ ([{ id: "text", load: () => import("../editor/index.js") }]);

const TOPIC = /^\/(?:[^/]+\/)?_aseba\/(?:target|variables|events)$|^\/aseba_runtime\/_behaviours$/;

export class ProgramHost {
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
    /** @type {typeof import("../editor/index.js") | null} */ this.module = null;
    /** @type {EditorSession | null} */ this.session = null;
    /** @type {Editor | null} the view, which stays alive while other tabs are shown */ this.view = null;
    /** @type {Context | null} */ this.context = null;
  }

  /** Whether the view currently needs a topic. @param {string} topic */
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
    if (this.isOpen) this.view?.redraw();
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    const hadView = this.view !== null;
    this.view?.destroy();
    this.view = null;
    if (this.isOpen || hadView) this.#build();
  }

  /** Show or hide the view: call when the tab is opened or left. @param {boolean} visible */
  async setVisible(visible) {
    if (visible === this.isOpen) return;
    this.isOpen = visible;
    if (visible && (await this.#load())) {
      if (this.view === null) this.#build();
      else this.view.show();
    }
    this.client().refresh();
  }

  /** Open the tab with a program that was dropped on the page or rejected elsewhere. @param {string} name @param {string} text */
  async openText(name, text) {
    (await this.#opened())?.openText(name, text);
  }

  /** Open the tab with a program file. @param {File} file */
  async openFile(file) {
    (await this.#opened())?.openFile(file);
  }

  /** The view, in the shown tab; null if it cannot be loaded. @returns {Promise<Editor | null>} */
  async #opened() {
    this.context?.workspace.select("program");
    if (!(await this.#load())) return null;
    if (this.view === null) this.#build();
    return this.view;
  }

  /** Load the module; returns whether it is there. */
  async #load() {
    this.module ??= await LANGUAGES[0].load().catch(() => null);
    if (this.module === null) {
      const { store, text } = /** @type {Context} */ (this.context);
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return false;
    }
    this.session ??= new this.module.EditorSession(localStore, Date.now);
    return true;
  }

  #build() {
    if (this.module === null || this.session === null || this.context === null) return;
    this.view = new this.module.Editor({ session: this.session, context: this.context });
    this.slot.append(this.view.element);
    this.view.start();
  }
}
