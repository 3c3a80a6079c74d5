// Integrates the playground creator into the page, as a mode of the tab "Playground": loads it on demand and runs its
// playground in the simulator. Another tab shows the running world again; the session stays, and the tab continues it.

import { localStore } from "../browser/local_storage.js";
import { translator } from "../i18n/index.js";
import { parseDraft } from "../playground/draft_text.js";
import { Fault } from "../playground/rules.js";
import { Drafts } from "../playground_tab/drafts.js";
import { CONNECTION } from "../state/index.js";
import { disabledReason } from "../state/disabled_reason.js";
import { keepFocus } from "../ui/focus.js";

/** @typedef {import("../creator/index.js").Creator} Creator */
/** @typedef {import("../creator/creator_session.js").CreatorSession} CreatorSession */
/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/parts.js").Item} Item */
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
    /** The playgrounds that were built on this device. */
    this.drafts = new Drafts(localStore);
    this.isOpen = false;
    /** Whether the tab continues the session when it is shown again. */
    this.isSuspended = false;
    /** Whether what was opened is seen as a preview, whose size is not exact. */
    this.isPreview = false;
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
    void this.session?.ask();
    this.creator?.render(disabledReason(store.state, text("page")));
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.isOpen) this.#build();
  }

  /**
   * Open the creator with a playground; without one, the session continues.
   *
   * @param {Playground} [playground]
   * @param {{ word?: string, inFile?: boolean }} [how]   word: what happened, for undo; inFile: whether a file has it
   */
  async open(playground, { word = "change.opened", inFile = false } = {}) {
    const module = await this.#load();
    const { context } = this;
    if (module === null || context === null) return;
    const isFirst = this.session === null;
    this.session ??= new module.CreatorSession({
      drafts: this.drafts,
      title: this.#title(module),
      report: (phrase) => this.creator?.report(phrase),
      changed: () => this.scene().invalidate(),
      learn: (items) => this.#learn(items),
    });
    if (playground !== undefined) {
      this.session.replacePlayground(playground, { word, values: { name: playground.title } }, inFile);
      this.scene().reframe();
    }
    this.isPreview = (isFirst || playground !== undefined) && !this.session.isKnown;
    this.isSuspended = false;
    context.workspace.select("playground");
    if (!this.isOpen) {
      const panel = this.element("#panel-playground");
      const hadFocus = panel.contains(document.activeElement);
      this.isOpen = true;
      window.addEventListener("pagehide", this.#keep);
      document.body.classList.add("creator-open");
      context.dragController.setMode(false);
      this.#build();
      // What had the focus is hidden now.
      if (hadFocus) firstControl(panel)?.focus();
    }
    this.scene().setView("home");
  }

  /** Build a new playground. */
  async openNew() {
    const module = await this.#load();
    if (module === null) return;
    const isFirst = this.session === null; // it starts with a new one
    await this.open(isFirst ? undefined : module.newPlayground(this.#title(module)), { word: "change.new" });
  }

  /** Go on building a playground of this device. @param {import("../playground_tab/drafts.js").Draft} draft */
  async openDraft({ id, inFile }) {
    const { playground } = this.session?.model ?? {};
    if (playground?.draft === id) return this.open();
    await this.openText(this.drafts.read(id) ?? "", { draft: id, inFile });
  }

  /**
   * Open a playground from text. Returns what is wrong if it is not in the format of this project, else null.
   *
   * @param {string} text
   * @param {{ draft?: string, inFile?: boolean }} [how]   draft: the one that is continued
   * @returns {Promise<Fault | null>}
   */
  async openText(text, { draft, inFile = false } = {}) {
    try {
      const playground = parseDraft(text);
      await this.open(draft === undefined ? playground : { ...playground, draft }, { inFile });
      return null;
    } catch (error) {
      if (error instanceof Fault) return error;
      throw error;
    }
  }

  /**
   * Keep a playground from elsewhere among those of this device, and show the running world. One that has no room, or that
   * the creator cannot read, is not kept.
   *
   * @param {string} text
   */
  keepCopy(text) {
    this.close();
    this.isSuspended = false;
    const { drafts } = this;
    if (drafts.list().some(({ id }) => drafts.read(id) === text)) return;
    try {
      drafts.keep({ id: drafts.newId(), title: parseDraft(text).title, inFile: false, text });
    } catch {
      // It is in the link, and the simulator says what is wrong with it.
    }
  }

  /** Open a file that was dropped on the page. @param {File} file @param {import("../browser/opened_file.js").Place} place */
  openFile(file, place) {
    this.creator?.open(file, place);
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
    keepFocus(
      document.body,
      () => this.creator?.destroy(),
      () => document.querySelector("#tab-playground"),
    );
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
      drawn: [...this.session.world.markers.keys()],
      camera: this.scene().camera.camera.position.toArray(),
    };
  }

  /** Show the bar of the creator instead of tray and time. @param {boolean} shown */
  #showBar(shown) {
    this.element("#creator-bar").hidden = !shown;
    for (const other of ["#tray", "#time"]) this.element(other).hidden = shown;
  }

  #keep = () => this.session?.keep();

  /** Ask the simulator for exact parts; the first ones of what was opened are framed. @param {readonly Item[]} items */
  async #learn(items) {
    const hasAnswer = (await this.context?.actions.learnParts(items)) ?? false;
    if (hasAnswer && this.isPreview) {
      this.isPreview = false;
      this.scene().reframe();
    }
    return hasAnswer;
  }

  /** The creator's module; null if the page's server is gone. */
  async #load() {
    const { context } = this;
    this.module ??= await import("../creator/index.js").catch(() => null);
    if (this.module === null && context !== null) {
      const text = context.text("page")("app.notLoaded");
      context.store.dispatch({ type: "notice", level: "error", text, cause: CONNECTION });
    }
    return this.module;
  }

  /** The title of a new playground. @param {typeof import("../creator/index.js")} module */
  #title({ WORDS }) {
    return translator(this.context?.language ?? "en", WORDS)("new.title");
  }

  /** Load the playground, or start the mission, in the simulator; if that is rejected, the creator stays open and shows the reason. */
  async #tryIt() {
    const { context, session, creator } = this;
    if (context === null || session === null || creator === null) return;
    const { actions, store, text, language } = context;
    creator.refuse(null);
    session.keep();
    if (session.model.playground.mission !== undefined) {
      const mission = creator.packMission();
      if (mission === null || !(await actions.startMission(mission.name, mission.content))) return;
      this.close();
      return creator.checkMission(mission);
    }
    const { fileName, text: content } = session;
    await actions.loadPlayground(fileName, new TextEncoder().encode(content));
    const upload = store.state.uploads.playground;
    if (upload?.phase === "accepted") return this.close();
    const { refusalView, reasonOfMessage } = await import("../playground_tab/refusal.js");
    const reason = upload?.fault ? reasonOfMessage(upload.fault, content) : null;
    creator.refuse(refusalView(language, text("playground")("refused", { name: fileName }), reason));
  }

  #build() {
    const { module, session, context } = this;
    if (module === null || session === null || context === null) return;
    this.creator?.destroy();
    this.creator = new module.Creator({
      session,
      context,
      tryIt: () => void this.#tryIt(),
      close: () => this.close(),
    });
    const { stage, side, footer, views, hints } = this.creator.elements;
    this.element("#scene").append(stage);
    this.element('[data-slot="views"]').prepend(views);
    this.element('[data-slot="views"]').append(hints); // below all buttons, however many rows they take
    this.element("#panel-playground").append(side);
    this.element("#creator-bar").append(footer);
    this.#showBar(true);
    this.scene().invalidate();
  }
}

/** @param {Element} panel */
function firstControl(panel) {
  const controls = /** @type {HTMLElement[]} */ ([...panel.querySelectorAll("button, input")]);
  return controls.find((each) => each.checkVisibility());
}
