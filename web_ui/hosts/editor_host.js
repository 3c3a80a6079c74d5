// Integrates the Aseba editor into the page: loads it on demand and forwards messages while it is open.

import { localStore } from "../browser/local_storage.js";
import { CONNECTION } from "../state/index.js";

/** @typedef {import("../editor/index.js").Editor} Editor */
/** @typedef {import("../editor/editor_session.js").EditorSession} EditorSession */
/** @typedef {import("../panels/index.js").Context} Context */

const TOPIC = /^\/(?:[^/]+\/)?_aseba\/(?:target|variables|events)$|^\/aseba_runtime\/_behaviours$/;

export class EditorHost {
  /**
   * @param {object} options
   * @param {HTMLElement} options.slot
   * @param {() => import("../protocol/client.js").Client} options.client
   * @param {() => void} options.changed   called when it is opened or closed
   */
  constructor({ slot, client, changed }) {
    this.slot = slot;
    this.client = client;
    this.changed = changed;
    this.isOpen = false;
    /** @type {typeof import("../editor/index.js") | null} */ this.module = null;
    /** @type {EditorSession | null} */ this.session = null;
    /** @type {Editor | null} */ this.editor = null;
    /** @type {Context | null} */ this.context = null;
  }

  /** Whether the editor currently needs a topic. @param {string} topic */
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
    if (this.isOpen) this.editor?.redraw();
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.isOpen) this.#build();
  }

  async open() {
    if (this.isOpen) return;
    this.module ??= await import("../editor/index.js").catch(() => null);
    if (this.module === null) {
      this.context?.store.dispatch({ type: "notice", level: "error", text: this.context.t("app.notLoaded"), cause: CONNECTION });
      return;
    }
    this.session ??= new this.module.EditorSession(localStore, Date.now);
    this.isOpen = true;
    document.body.classList.add("with-editor");
    this.slot.hidden = false;
    this.#build();
    this.client().refresh();
    this.changed();
  }

  close() {
    if (!this.isOpen) return;
    this.isOpen = false;
    this.editor?.destroy();
    this.editor = null;
    document.body.classList.remove("with-editor");
    this.slot.hidden = true;
    this.client().refresh();
    this.changed();
  }

  /** Open a program that was dropped on the page or rejected elsewhere. @param {string} name @param {string} text */
  async openText(name, text) {
    await this.open();
    this.editor?.commands.openText(name, text);
  }

  #build() {
    if (this.module === null || this.session === null || this.context === null) return;
    this.editor?.destroy();
    const { t, language, store, announce } = this.context;
    this.editor = new this.module.Editor({
      session: this.session,
      client: this.client(),
      store,
      language,
      pageText: t,
      announce,
      close: () => this.close(),
    });
    this.slot.replaceChildren(this.editor.element);
    this.editor.start();
  }
}
