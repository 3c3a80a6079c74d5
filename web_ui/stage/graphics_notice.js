// The notice over the 3D view when the browser has lost its graphics context, or supports no WebGL. The second stays
// true, so the user can hide it.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

export class GraphicsNotice {
  /** @type {"lost" | "gone" | null} gone: permanently, drawn in 2D; null: working */
  #trouble = null;
  #isHidden = false;

  /**
   * @param {HTMLElement} element
   * @param {import("../i18n/index.js").Translate} pageText  in the current language
   * @param {() => void} changed   called when the notice was hidden: the 2D view has more room
   */
  constructor(element, pageText, changed) {
    this.element = element;
    this.pageText = pageText;
    this.changed = changed;
  }

  /** @param {"lost" | "gone" | null} trouble */
  set(trouble) {
    this.#trouble = trouble;
    this.render();
  }

  /** Write the text: also after a change of language. */
  render() {
    const trouble = this.#trouble;
    this.element.hidden = trouble === null || (trouble === "gone" && this.#isHidden);
    this.element.dataset.kind = trouble ?? "";
    const text = trouble === null ? "" : this.pageText(trouble === "lost" ? "app.contextLost" : "app.noWebgl");
    this.element.replaceChildren(h("p", { class: "grow" }, text), ...(trouble === "gone" ? [this.#hideButton()] : []));
  }

  #hideButton() {
    const hide = () => {
      this.#isHidden = true;
      this.render();
      this.changed();
    };
    const label = this.pageText("notice.dismiss");
    return h("button", { type: "button", class: "btn icon", "aria-label": label, onclick: hide }, icon("close"));
  }
}
