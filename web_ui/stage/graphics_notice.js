// The notice over the 3D view when the browser has lost its graphics context, or supports no WebGL.

export class GraphicsNotice {
  /** @type {"lost" | "gone" | null} gone: permanently, drawn in 2D; null: working */
  #trouble = null;

  /** @param {HTMLElement} element @param {import("../i18n/index.js").Translate} t  in the current language */
  constructor(element, t) {
    this.element = element;
    this.t = t;
  }

  /** @param {"lost" | "gone" | null} trouble */
  set(trouble) {
    this.#trouble = trouble;
    this.render();
  }

  /** Write the text: also after a change of language. */
  render() {
    const trouble = this.#trouble;
    this.element.hidden = trouble === null;
    this.element.dataset.kind = trouble ?? "";
    this.element.textContent = trouble === null ? "" : this.t(trouble === "lost" ? "app.contextLost" : "app.noWebgl");
  }
}
