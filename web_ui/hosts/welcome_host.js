// Integrates the first visit into the page: four ways to start over the scene, the offer of the tour, and what "?" opens.
// Loaded on demand; a visit without any of it loads nothing.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { CONNECTION } from "../state/index.js";
import { isSomethingOpen } from "../ui/sheet.js";

/** @typedef {import("../shell/context.js").Context} Context */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {typeof import("../welcome/index.js")} Module */

/** Storage key: whether a start has been chosen. */
const KEY = "welcome";
const CHOSEN = "chosen";

/**
 * Whether this browser has not chosen anything yet. In the address, `welcome=off` and `welcome=on` decide.
 *
 * @param {object} visit
 * @param {boolean | null} visit.wanted   as the address says; null: nothing
 * @param {Pick<import("../browser/local_storage.js").KeyValueStore, "getItem">} visit.storage
 * @param {unknown} visit.entry           history state of this visit; available even without storage
 */
export function isFirstVisit({ wanted, storage, entry }) {
  if (wanted !== null) return wanted;
  return storage.getItem(KEY) !== CHOSEN && /** @type {any} */ (entry)?.[KEY] !== CHOSEN;
}

/**
 * Whether the four starts can be shown now: they act on a robot, and lie over the scene and the card of a mission.
 *
 * @param {Pick<State, "connection" | "identified" | "readOnly" | "robots" | "mission">} state
 * @param {boolean} isBuilding   whether the creator shows its own playground
 */
export function canStart({ connection, identified, readOnly, robots, mission }, isBuilding) {
  const isFree = mission === null && !isBuilding;
  return connection === "connected" && identified && !readOnly && Object.keys(robots).length > 0 && isFree;
}

/**
 * Whether the offer of the tour has a place: it would lie over an open workspace, and over the card of a mission.
 *
 * @param {Pick<State, "connection" | "identified" | "mission">} state
 * @param {string | null} tab  the open one
 */
export function canOffer({ connection, identified, mission }, tab) {
  return connection === "connected" && identified && mission === null && tab === null;
}

export class WelcomeHost {
  /** @param {HTMLElement} slot */
  constructor(slot) {
    this.slot = slot;
    /** Whether the four starts are wanted. */
    this.isWanted = false;
    /** @type {Context | null} */ this.context = null;
    /** @type {Module | null} */ this.module = null;
    this.isAsked = false;
    /** @type {ReturnType<Module["createStarts"]> | null} */ this.starts = null;
    /** @type {ReturnType<Module["createTourOffer"]> | null} */ this.offer = null;
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    if (this.context === null) {
      const { welcome: wanted } = context.visit;
      this.isWanted = isFirstVisit({ wanted, storage: localStore, entry: history.state });
      context.workspace.subscribe(() => {
        if (context.workspace.tab !== null) this.close(); // something else was chosen
      });
      if (context.workspace.tab !== null) this.isWanted = wanted === true;
      window.addEventListener("keydown", this.#key, { capture: true });
    }
    this.context = context;
    this.#remove();
  }

  /** Whether the four starts are shown. */
  get isOpen() {
    return this.starts !== null;
  }

  /** Show the four starts again. */
  open() {
    this.context?.workspace.select(null);
    this.isWanted = true;
    this.context?.scene.invalidate();
  }

  /** Hide the four starts for good: only "?" shows them again. */
  close() {
    if (!this.isWanted) return;
    this.isWanted = false;
    trySetItem(localStore, KEY, CHOSEN);
    history.replaceState({ ...history.state, [KEY]: CHOSEN }, "");
    this.context?.scene.invalidate();
  }

  /** Show all keys. */
  async openKeys() {
    const module = await this.#load();
    if (module !== null && this.context !== null) module.openKeys(this.context.language);
  }

  /** Call once per frame. @param {State} state */
  render(state) {
    const { context } = this;
    if (context === null) return;
    // The tour shows what the starts would hide.
    const showsStarts = this.isWanted && !context.tour.isOpen && canStart(state, context.creator.isOpen);
    const showsOffer = context.tour.isOffered && canOffer(state, context.workspace.tab);
    if ((showsStarts || showsOffer) && this.module === null) {
      if (!this.isAsked) void this.#load(true).then(() => context.scene.invalidate());
      return;
    }
    if (this.module === null) return;
    if (showsStarts !== (this.starts !== null)) {
      this.starts?.destroy();
      this.starts = showsStarts ? this.module.createStarts(context, this.slot, () => this.close()) : null;
    }
    if (showsOffer !== (this.offer !== null)) {
      this.offer?.destroy();
      this.offer = showsOffer ? this.module.createTourOffer(context) : null;
    }
    this.starts?.render(state);
  }

  #remove() {
    this.starts?.destroy();
    this.offer?.destroy();
    this.starts = null;
    this.offer = null;
  }

  /** Escape hides the starts before it stops robots. @param {KeyboardEvent} event */
  #key = (event) => {
    if (event.key !== "Escape" || !this.isOpen || isSomethingOpen()) return;
    event.stopPropagation();
    this.close();
  };

  /** @param {boolean} [isQuiet]  whether a failure is not reported, because no user asked for it @returns {Promise<Module | null>} */
  async #load(isQuiet = false) {
    this.isAsked = true;
    this.module ??= await import("../welcome/index.js").catch(() => null);
    if (this.module === null && !isQuiet && this.context !== null) {
      const { store, text } = this.context;
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
    }
    return this.module;
  }
}
