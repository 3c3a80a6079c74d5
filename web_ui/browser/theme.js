// The theme: light, dark, or as the system. The browser remembers the choice; style sheets and the scene follow it.

import { trySetItem } from "./local_storage.js";

/** @typedef {"system" | "light" | "dark"} ThemeChoice */

export const THEMES = /** @type {readonly ThemeChoice[]} */ (["system", "light", "dark"]);
const KEY = "theme";

export class Theme {
  /**
   * @param {object} options
   * @param {import("./local_storage.js").KeyValueStore} options.storage
   * @param {Pick<MediaQueryList, "matches" | "addEventListener">} options.systemIsDark   (prefers-color-scheme: dark)
   * @param {Pick<HTMLElement, "setAttribute" | "removeAttribute">} options.root          gets data-theme
   */
  constructor({ storage, systemIsDark, root }) {
    this.storage = storage;
    this.systemIsDark = systemIsDark;
    this.root = root;
    /** @type {(() => void)[]} */ this.listeners = [];
    const kept = storage.getItem(KEY);
    this.choice = THEMES.find((theme) => theme === kept) ?? "system";
    systemIsDark.addEventListener("change", () => this.choice === "system" && this.#apply());
    this.#apply();
  }

  /** Whether the page is dark now. */
  get isDark() {
    return this.choice === "system" ? this.systemIsDark.matches : this.choice === "dark";
  }

  /** @param {ThemeChoice} choice */
  choose(choice) {
    this.choice = choice;
    trySetItem(this.storage, KEY, choice);
    this.#apply();
  }

  /** @param {() => void} listener  called when the page becomes light or dark */
  subscribe(listener) {
    this.listeners.push(listener);
  }

  #apply() {
    if (this.choice === "system") this.root.removeAttribute("data-theme");
    else this.root.setAttribute("data-theme", this.choice);
    for (const listener of this.listeners) listener();
  }
}
