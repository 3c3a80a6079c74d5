// Integrates the playground creator into the page, as a mode of the tab "Playground": loads it on demand and runs its
// playground in the simulator. Another tab shows the running world again; the session stays, and the tab continues it.

import { localStore } from "../browser/local_storage.js";
import { translator } from "../i18n/index.js";
import { parse } from "../playground/document.js";
import { faultView } from "../playground_tab/refusal.js";
import { CONNECTION } from "../state/index.js";
import { disabledReason } from "../state/disabled_reason.js";

/** @typedef {import("../creator/index.js").Creator} Creator */
/** @typedef {import("../creator/creator_session.js").CreatorSession} CreatorSession */
/** @typedef {import("../shell/context.js").Context} Context */

export class CreatorHost {
  /**
   * @param {object} options
   * @param {(selector: string) => HTMLElement} options.element  finds an element of index.html
   * @param {() => import("../scene/index.js").SceneView} options.scene
   */
  constructor({ element, scene }) {
    this.element = element;
    this.scene = scene;
    this.isOpen = false;
    /** Whether the tab continues the session when it is shown again. */
    this.isSuspended = false;
    /** @type {typeof import("../creator/index.js") | null} */ this.module = null;
    /** @type {CreatorSession | null} */ this.session = null;
    /** @type {Creator | null} */ this.creator = null;
    /** @type {Context | null} */ this.context = null;
  }

  /** The world to draw instead of the simulator's; null while the creator is closed. */
  get world() {
    return this.isOpen ? (this.session?.world ?? null) : null;
  }

  /** The overlay to draw over the world. */
  get sketch() {
    return this.isOpen ? (this.session?.sketch ?? null) : null;
  }

  /** Call once per frame, before drawing. */
  render() {
    if (!this.isOpen || this.context === null) return;
    const { store, text } = this.context;
    this.creator?.render(disabledReason(store.state, text("page")));
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.isOpen) this.#build();
  }

  /**
   * Open the creator, continuing the session or with a new playground.
   *
   * @param {import("../playground/document.js").Playground} [playground]
   */
  async open(playground) {
    const { context } = this;
    if (context === null) return;
    this.module ??= await import("../creator/index.js").catch(() => null);
    if (this.module === null) {
      context.store.dispatch({ type: "notice", level: "error", text: context.text("page")("app.notLoaded"), cause: CONNECTION });
      return;
    }
    const title = translator(context.language, this.module.WORDS)("new.title");
    this.session ??= new this.module.CreatorSession({
      storage: localStore,
      title,
      report: (phrase) => this.creator?.report(phrase),
      changed: () => this.scene().invalidate(),
    });
    if (playground !== undefined) {
      this.session.replacePlayground(playground, { word: "change.opened", values: { name: playground.title } });
      this.scene().reframe();
    }
    this.isSuspended = false;
    context.workspace.select("playground");
    if (!this.isOpen) {
      this.isOpen = true;
      window.addEventListener("pagehide", this.#keep);
      document.body.classList.add("creator-open");
      context.dragController.setMode(false);
      this.#build();
    }
    this.scene().setView("home");
  }

  /** Open a playground from text. Throws Fault if it is not in the format of this project. @param {string} text */
  async openText(text) {
    await this.open(parse(text));
  }

  /** Open a file that was dropped on the page. @param {File} file */
  openFile(file) {
    this.creator?.open(file);
  }

  /** Call when a tab is opened. @param {boolean} visible  whether it is the tab of playgrounds */
  setVisible(visible) {
    if (!visible && this.isOpen) {
      this.close();
      this.isSuspended = true;
    } else if (visible && this.isSuspended) void this.open();
  }

  close() {
    if (!this.isOpen) return;
    this.session?.keep();
    this.isOpen = false;
    window.removeEventListener("pagehide", this.#keep);
    this.creator?.destroy();
    this.creator = null;
    document.body.classList.remove("creator-open");
    this.#showBar(false);
    this.scene().setView("home");
  }

  /** Plain data for tests; null before the creator was first opened. */
  snapshot() {
    if (this.session === null) return null;
    const { playground, selected, placing, ghost, cameraOn, history } = this.session.model;
    return {
      isOpen: this.isOpen,
      playground,
      selected,
      placing: placing === null ? null : { kind: placing.kind, place: placing.place, points: placing.points.length },
      problem: ghost?.problem?.word ?? null,
      cameraOn,
      steps: history.past.length,
      camera: this.scene().camera.camera.position.toArray(),
    };
  }

  /** Show the bar of the creator instead of tray and time. @param {boolean} shown */
  #showBar(shown) {
    this.element("#creator-bar").hidden = !shown;
    for (const other of ["#tray", "#time"]) this.element(other).hidden = shown;
  }

  #keep = () => this.session?.keep();

  /** Load the playground into the simulator; if it is rejected, the creator stays open and shows the reason. */
  async #tryIt() {
    const { context, session, creator } = this;
    if (context === null || session === null || creator === null) return;
    const { actions, store, text } = context;
    const playgroundText = text("playground");
    creator.refuse(null);
    await actions.loadPlayground(session.fileName, new TextEncoder().encode(session.text));
    const upload = store.state.uploads.playground;
    if (upload?.phase === "accepted") this.close();
    else {
      const headline = playgroundText("playground.refused", { name: session.fileName });
      creator.refuse(faultView(playgroundText, headline, upload?.fault ?? null));
    }
  }

  #build() {
    const { module, session, context } = this;
    if (module === null || session === null || context === null) return;
    this.creator?.destroy();
    this.creator = new module.Creator({
      session,
      language: context.language,
      text: context.text,
      scene: this.scene(),
      announce: context.announce,
      tryIt: () => void this.#tryIt(),
      close: () => this.close(),
    });
    const { stage, side, footer } = this.creator.elements;
    this.element("#scene").append(stage);
    this.element("#panel-playground").append(side);
    this.element("#creator-bar").append(footer);
    this.#showBar(true);
    this.scene().invalidate();
  }
}
