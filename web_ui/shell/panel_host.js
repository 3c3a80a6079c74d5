// Puts the panels into the page: all of them are created again when the language changes.

import { HEADER } from "../header/index.js";
import { classPanel } from "../hosts/class_host.js";
import { PLAYGROUND_TAB } from "../playground_tab/index.js";
import { PROGRAM_TAB } from "../program_tab/index.js";
import { ROBOT_TAB } from "../robot_tab/index.js";
import { STAGE } from "../stage/index.js";
import { TABS } from "./workspace.js";

/** @typedef {import("./context.js").Panel} Panel */

/** All panels; within a slot they are in the order of the focus. */
const PANELS = [...HEADER, ...ROBOT_TAB, ...PROGRAM_TAB, ...PLAYGROUND_TAB, classPanel, ...STAGE];

export class PanelHost {
  /**
   * @param {(selector: string) => HTMLElement} element  finds an element of index.html
   * @param {import("./workspace.js").Workspace} workspace
   */
  constructor(element, workspace) {
    this.element = element;
    this.workspace = workspace;
    /** @type {Panel[]} */ this.panels = [];
  }

  /** @param {import("./context.js").Context} context */
  build(context) {
    for (const panel of this.panels) panel.element.remove();
    this.panels = PANELS.map((create) => create(context));
    for (const { slot, element } of this.panels) this.element(`[data-slot="${slot}"]`).append(element);
  }

  /** Call once per frame. @param {import("../state/index.js").State} state */
  render(state) {
    for (const panel of this.panels) {
      panel.watch?.(state);
      if (this.#isShown(panel.slot)) panel.render?.(state);
    }
  }

  /** @param {import("./context.js").Slot} slot */
  #isShown(slot) {
    const tab = TABS.find((name) => name === slot);
    return tab === undefined || tab === this.workspace.tab;
  }
}
