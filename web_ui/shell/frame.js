// Applies layout and workspace to the page: which panel is shown, how wide the workspace is, what a phone shows. The
// style sheets do the rest, by `data-layout`, `data-work` and `data-screen` of the body.

import { isLow, layoutOf, workWidth } from "../ui/layout.js";
import { TABS } from "./workspace.js";

/** @typedef {import("../ui/layout.js").Layout} Layout */

export class Frame {
  /**
   * @param {object} options
   * @param {(selector: string) => HTMLElement} options.element  finds an element of index.html
   * @param {import("./workspace.js").Workspace} options.workspace
   */
  constructor({ element, workspace }) {
    this.element = element;
    this.workspace = workspace;
    /** @type {Layout} */ this.layout = layoutOf(window.innerWidth);
    /** @type {(() => void)[]} */ this.listeners = [];
    workspace.subscribe(() => this.update());
    window.addEventListener("resize", () => this.update());
    this.update();
  }

  /** Whether the window is so low that the tray starts folded. */
  get isLow() {
    return isLow(window.innerHeight);
  }

  /** The width of the workspace in CSS pixels, if it has a place of its own beside the stage. */
  get workWidth() {
    const { workspace } = this;
    const tab = workspace.tab ?? "robot";
    return workWidth(window.innerWidth, workspace.usualWidth(tab), workspace.chosenWidth(tab));
  }

  /** @param {() => void} listener  called when layout or workspace have changed */
  subscribe(listener) {
    this.listeners.push(listener);
  }

  /** Call when the window or the workspace has changed. */
  update() {
    const { workspace } = this;
    const { body } = document;
    this.layout = layoutOf(window.innerWidth);
    body.dataset.layout = this.layout;
    body.dataset.work = workspace.tab === null ? "rail" : "open";
    body.dataset.screen = workspace.screen;
    body.style.setProperty("--work", `${this.workWidth}px`);
    for (const tab of TABS) this.element(`#panel-${tab}`).hidden = tab !== workspace.tab;
    for (const listener of this.listeners) listener();
  }
}
