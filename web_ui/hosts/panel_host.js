// Puts the panels into the page: all of them are created again when the language changes.

import { PANELS } from "../panels/index.js";

/** @typedef {import("../panels/index.js").Panel} Panel */

export class PanelHost {
  /** @param {(selector: string) => HTMLElement} element  finds an element of index.html */
  constructor(element) {
    this.element = element;
    /** @type {Panel[]} */ this.panels = [];
  }

  /** @param {import("../panels/index.js").Context} context */
  build(context) {
    const { t, language } = context;
    document.documentElement.lang = language;
    document.title = t("app.title");
    this.element("#title").textContent = t("app.title");
    this.element("#drop").textContent = t("app.drop");
    this.element("#view").setAttribute("aria-label", t("view.canvas"));
    this.element("aside").setAttribute("aria-label", t("app.panels"));
    document.querySelectorAll(".banner, .hint").forEach((banner) => banner.remove());
    for (const panel of this.panels) panel.element.remove();
    this.panels = PANELS.map((create) => create(context));
    for (const { slot, element } of this.panels) this.element(`[data-slot="${slot}"]`).append(element);
  }

  /** Call once per frame. @param {import("../state/index.js").State} state */
  render(state) {
    for (const panel of this.panels) panel.render?.(state);
  }
}
