// Integrates the tour into the page: offered at the first visit, never again after it was closed or declined, and opened on
// request.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { visitOptions } from "../browser/visit_options.js";
import { CONNECTION } from "../state/index.js";

/** @typedef {import("../tour/index.js").Tour} Tour */
/** @typedef {import("../shell/context.js").Context} Context */

const KEY = "tour";
const CLOSED = "closed";

/**
 * Whether a visit begins with the tour: "open", "offered" by a card, or "closed", as it is after it was closed or declined.
 * In the address, `tour=off` prevents it (kiosks, tests), and `tour=on` opens it even if it was closed before.
 *
 * @param {object} visit
 * @param {string} visit.search             query part of the address
 * @param {Pick<import("../browser/local_storage.js").KeyValueStore, "getItem">} visit.storage
 * @param {unknown} visit.entry             history state of this visit; available even without storage
 * @returns {"open" | "offered" | "closed"}
 */
export function tourOf({ search, storage, entry }) {
  const { tour } = visitOptions(search);
  if (tour !== null) return tour ? "open" : "closed";
  const isClosed = storage.getItem(KEY) === CLOSED || /** @type {any} */ (entry)?.[KEY] === CLOSED;
  return isClosed ? "closed" : "offered";
}

export class TourHost {
  constructor() {
    this.step = 0;
    /** Whether a card offers the tour. */
    this.isOffered = false;
    /** @type {Tour | null} */ this.tour = null;
    /** @type {typeof import("../tour/index.js") | null} */ this.module = null;
    /** @type {Context | null} */ this.context = null;
    /** @type {Element | null} previously focused element */ this.previousFocus = null;
  }

  get isOpen() {
    return this.tour !== null;
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.isOpen) this.#build();
  }

  /** Call once, when the page is ready. */
  start() {
    const begin = tourOf({ search: location.search, storage: localStore, entry: history.state });
    this.isOffered = begin === "offered";
    if (begin === "open") void this.open();
  }

  async open() {
    if (this.isOpen) return;
    this.isOffered = false;
    const { activeElement } = document;
    this.module ??= await import("../tour/index.js").catch(() => null);
    if (this.module === null) {
      const { store, text } = /** @type {Context} */ (this.context);
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return;
    }
    this.previousFocus = activeElement;
    this.step = 0;
    this.#build();
  }

  /** Never offer the tour again: only the button in the header opens it. */
  decline() {
    this.isOffered = false;
    trySetItem(localStore, KEY, CLOSED);
    history.replaceState({ ...history.state, [KEY]: CLOSED }, "");
  }

  /** Close the tour permanently. */
  close() {
    this.tour?.destroy();
    this.tour = null;
    this.decline();
    const place = this.previousFocus instanceof HTMLElement && this.previousFocus !== document.body ? this.previousFocus : null;
    (place?.isConnected ? place : /** @type {HTMLElement | null} */ (document.querySelector("#help-open")))?.focus();
  }

  /** Call once per frame: the described element may have moved. */
  render() {
    this.tour?.render();
  }

  #build() {
    if (this.module === null || this.context === null) return;
    this.tour?.destroy();
    this.tour = new this.module.Tour({
      language: this.context.language,
      step: this.step,
      stepped: (step) => {
        this.step = step;
      },
      close: () => this.close(),
    });
    this.tour.start();
  }
}
