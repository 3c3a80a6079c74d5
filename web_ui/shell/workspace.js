// Which tab of the workspace is open, and how wide it is. The browser remembers both. No DOM.

import { trySetItem } from "../browser/local_storage.js";

/** @typedef {"robot" | "program" | "playground" | "class"} Tab */
/** @typedef {"drive" | Tab} Screen   what a phone shows */

export const TABS = /** @type {readonly Tab[]} */ (["robot", "program", "playground", "class"]);

/** Width of each tab until the user drags the grip. */
const USUAL_PX = /** @type {Readonly<Record<Tab, number>>} */ ({
  robot: 480,
  program: 752,
  playground: 416,
  class: 576,
});
const TAB_KEY = "workspace.tab";
const CLOSED = "closed";
/** @param {Tab} tab */
const widthKey = (tab) => `workspace.width.${tab}`;

export class Workspace {
  /** @param {import("../browser/local_storage.js").KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
    const kept = storage.getItem(TAB_KEY);
    /** @type {Tab | null} the open tab; null: closed. The first visit is closed. */
    this.tab = TABS.find((tab) => tab === kept && tab !== "class") ?? null;
    /** Whether the class was open at the last visit; it opens when there are several robots. */
    this.wantsClass = kept === "class";
    /** Tabs that are offered; "class" only with several robots. @type {readonly Tab[]} */
    this.offered = TABS.filter((tab) => tab !== "class");
    /** @type {(() => void)[]} */ this.listeners = [];
  }

  /** What a phone shows. @returns {Screen} */
  get screen() {
    return this.tab ?? "drive";
  }

  /** Open a tab, or close the workspace. @param {Tab | null} tab */
  select(tab) {
    if (tab === this.tab || (tab !== null && !this.offered.includes(tab))) return;
    this.tab = tab;
    this.wantsClass = false;
    trySetItem(this.storage, TAB_KEY, tab ?? CLOSED);
    this.#report();
  }

  /** Offer the tab of the class or not. @param {boolean} isClass  whether there are several robots */
  offerClass(isClass) {
    if (isClass === this.offered.includes("class")) return;
    this.offered = isClass ? TABS : TABS.filter((tab) => tab !== "class");
    if (!isClass && this.tab === "class") this.tab = "robot";
    if (isClass && this.wantsClass) this.tab = "class";
    this.wantsClass = false;
    this.#report();
  }

  /** The width that a tab has by itself. @param {Tab} tab */
  usualWidth(tab) {
    return USUAL_PX[tab];
  }

  /** The width that the user chose for a tab; null: never. @param {Tab} tab */
  chosenWidth(tab) {
    const kept = Number(this.storage.getItem(widthKey(tab)));
    return kept > 0 ? kept : null;
  }

  /** Keep the width of the open tab; null forgets it. @param {number | null} width  CSS pixels */
  setWidth(width) {
    if (this.tab === null) return;
    if (width === null) this.storage.removeItem(widthKey(this.tab));
    else trySetItem(this.storage, widthKey(this.tab), String(Math.round(width)));
    this.#report();
  }

  /** @param {() => void} listener */
  subscribe(listener) {
    this.listeners.push(listener);
  }

  #report() {
    for (const listener of this.listeners) listener();
  }
}
