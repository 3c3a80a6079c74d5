// The place of the playground creator on the page: loads it when it is first opened, and lets it be tried in the
// simulator.

import { localStore } from "../browser/local_storage.js";
import { faultView } from "../panels/fault.js";
import { parse } from "../playground/document.js";
import { CONNECTION } from "../state/index.js";

/** @typedef {import("../creator/index.js").Creator} Creator */
/** @typedef {import("../creator/creator_session.js").CreatorSession} CreatorSession */
/** @typedef {import("../panels/index.js").Context} Context */

/** The tools stand at the left of the view. */
const PALETTE_PX = 66;

export class CreatorHost {
  /**
   * @param {object} options
   * @param {(slot: "stage" | "creator" | "footer") => HTMLElement} options.slot
   * @param {() => import("../scene/index.js").SceneView} options.scene
   */
  constructor({ slot, scene }) {
    this.slot = slot;
    this.scene = scene;
    this.isOpen = false;
    /** @type {typeof import("../creator/index.js") | null} */ this.module = null;
    /** @type {CreatorSession | null} */ this.session = null;
    /** @type {Creator | null} */ this.creator = null;
    /** @type {Context | null} */ this.context = null;
  }

  /** What the scene draws instead of the simulator's world; null while nobody builds. */
  get world() {
    return this.isOpen ? (this.session?.world ?? null) : null;
  }

  /** What is drawn over it. */
  get sketch() {
    return this.isOpen ? (this.session?.sketch ?? null) : null;
  }

  /** Once a frame, before it is drawn. */
  render() {
    if (!this.isOpen || this.context === null) return;
    const { store, t } = this.context;
    this.creator?.render(store.state.connection === "connected" ? "" : t("connection.needed"));
  }

  /** The page has other words, or is new. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.isOpen) this.#build();
  }

  /** Go on building, or with this playground. @param {import("../playground/document.js").Playground} [playground] */
  async open(playground) {
    const { context } = this;
    if (context === null) return;
    this.module ??= await import("../creator/index.js").catch(() => null);
    if (this.module === null) {
      context.store.dispatch({ type: "notice", level: "error", text: context.t("app.notLoaded"), cause: CONNECTION });
      return;
    }
    const title = this.module.WORDS[context.language]["new.title"];
    this.session ??= new this.module.CreatorSession({
      storage: localStore,
      title,
      report: (phrase) => this.creator?.report(phrase),
      changed: () => this.scene().invalidate(),
    });
    if (playground !== undefined) {
      this.session.replacePlayground(playground, { word: "did.opened", values: { name: playground.title } });
      this.scene().reframe();
    }
    if (!this.isOpen) {
      this.isOpen = true;
      window.addEventListener("pagehide", this.#keep);
      document.body.classList.add("building");
      this.slot("creator").hidden = false;
      context.dragController.setMode(false);
      context.editor.close(); // there is room for one of them
      this.scene().camera.setInset(PALETTE_PX);
      this.#build();
    }
    this.scene().setView("home");
  }

  /** Go on with a playground of the simulator's. Fails with a Fault for one that is not ours. @param {string} text */
  async openText(text) {
    await this.open(parse(text));
  }

  /** A file dropped on the page while one builds. @param {File} file */
  openFile(file) {
    this.creator?.open(file);
  }

  close() {
    if (!this.isOpen) return;
    this.session?.keep();
    this.isOpen = false;
    window.removeEventListener("pagehide", this.#keep);
    this.creator?.destroy();
    this.creator = null;
    document.body.classList.remove("building");
    this.slot("creator").hidden = true;
    this.scene().camera.setInset(0);
    this.scene().setView("home");
  }

  /** What tests see of it: plain data; null before it is first opened. */
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

  #keep = () => this.session?.keep();

  /** Give it to the simulator; what it refuses stays here, with its reason. */
  async #tryIt() {
    const { context, session, creator } = this;
    if (context === null || session === null || creator === null) return;
    const { actions, store, t } = context;
    creator.refuse(null);
    await actions.loadPlayground(session.fileName, new TextEncoder().encode(session.text));
    const upload = store.state.uploads.playground;
    if (upload?.phase === "accepted") this.close();
    else creator.refuse(faultView(t, t("playground.refused", { name: session.fileName }), upload?.fault ?? null));
  }

  #build() {
    const { module, session, context } = this;
    if (module === null || session === null || context === null) return;
    this.creator?.destroy();
    this.creator = module.createCreator({
      session,
      language: context.language,
      pageText: context.t,
      scene: this.scene(),
      announce: context.announce,
      tryIt: () => void this.#tryIt(),
      close: () => this.close(),
    });
    const { stage, side, footer } = this.creator.elements;
    this.slot("stage").append(stage);
    this.slot("creator").append(side);
    this.slot("footer").append(footer);
    this.scene().invalidate();
  }
}
