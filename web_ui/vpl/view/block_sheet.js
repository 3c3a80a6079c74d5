// The editor of a block: its picture, large, with parts that can be pressed, and sliders and choices around it. There is
// one sheet; each change takes effect at once.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { nameKey } from "../blocks.js";
import { controlsOf, used } from "./controls.js";
import { move, openBeside } from "./open_beside.js";
import { picture } from "./picture.js";
import { sentence } from "./sentences.js";
import { partOf } from "./sheet_parts.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {import("./controls.js").Control} Control */
/** @typedef {import("./sheet_parts.js").Part} Part */
/**
 * @typedef {object} SheetOptions
 * @property {import("../../i18n/index.js").Translate} t
 * @property {(block: Block, series: string) => void} change
 * @property {() => void} endSeries   the gesture is over
 * @property {() => void} copy
 * @property {() => void} remove
 * @property {() => void} closed
 */

export class BlockSheet {
  /** @type {Block | null} the one that is edited */ #block = null;
  /** @type {Mode} */ #mode = "basic";
  /** @type {Element | null} of the block */ #button = null;
  /** @type {Part[]} */ #parts = [];
  /** What decides which parts there are, as it was when they were created. */
  #structure = "";

  /** @param {SheetOptions} options */
  constructor(options) {
    const { t, endSeries, closed } = options;
    this.options = options;
    this.title = h("h3", { id: "vpl-block-title" });
    this.large = h("div", { class: "vpl-large" });
    this.body = h("div", { class: "vpl-sheet-body" });
    this.plain = h("p", { class: "small muted" }, t("block.plain"));
    this.element = h(
      "div",
      {
        id: "vpl-block",
        class: "sheet vpl-sheet",
        popover: "auto",
        role: "dialog",
        "aria-labelledby": "vpl-block-title",
      },
      this.title,
      this.body,
      this.plain,
      this.#foot(),
    );
    this.element.addEventListener("toggle", () => {
      if (this.element.matches(":popover-open")) return;
      this.#block = null;
      endSeries();
      closed();
    });
  }

  get isOpen() {
    return this.#block !== null;
  }

  close() {
    this.element.hidePopover();
  }

  /** Edit a block beside its button. @param {Block} opened @param {Mode} inMode @param {Element} beside */
  open(opened, inMode, beside) {
    [this.#block, this.#mode, this.#button] = [opened, inMode, beside];
    this.#structure = "";
    this.#draw(opened);
    openBeside(this.element, beside);
    /** @type {HTMLElement | null} */ const done = this.element.querySelector(".you");
    /** @type {HTMLElement | null} */ (this.body.querySelector("button, input") ?? done)?.focus();
  }

  /** The block has changed. @param {Block | null} changed @param {Mode} inMode @param {Element | null} beside */
  update(changed, inMode, beside) {
    if (this.#block === null || changed === this.#block) return;
    if (changed === null || changed.name !== this.#block.name) return this.close();
    const old = this.#structure;
    const { activeElement } = document;
    const isInside = activeElement instanceof HTMLElement && this.element.contains(activeElement);
    const value = isInside ? activeElement.dataset.value : undefined;
    [this.#block, this.#mode, this.#button] = [changed, inMode, beside ?? this.#button];
    this.#draw(changed);
    if (old === this.#structure) return;
    if (this.#button !== null) move(this.element, this.#button);
    const next = value === undefined ? "button, input" : `[data-value="${value}"]`;
    /** @type {HTMLElement | null} */ (this.body.querySelector(next))?.focus();
  }

  #foot() {
    const { t, copy, remove } = this.options;
    /**
     * @param {string} name
     * @param {import("../../ui/icons.js").IconName} sign
     * @param {string} look
     * @param {() => void} [act]
     */
    const action = (name, sign, look, act) => {
      const onclick = () => {
        this.close();
        act?.();
      };
      const attributes = { type: "button", class: `btn note ${look}`, "data-block-verb": name, onclick };
      return h("button", attributes, icon(sign, { small: true }), t(`block.${name}`));
    };
    return h(
      "div",
      { class: "row vpl-sheet-foot" },
      action("copy", "copy", "line", copy),
      action("remove", "remove", "line", remove),
      h("span", { class: "grow" }),
      action("done", "check", "you"),
    );
  }

  /** @param {Block} block */
  #draw(block) {
    const controls = controlsOf(block, this.#mode);
    const structure = JSON.stringify([block.name, controls.map((each) => [each.kind, "area" in each ? each.area : 0])]);
    setText(this.title, this.options.t(nameKey(block)));
    setAttribute(this.element, "data-block", block.name);
    if (structure !== this.#structure) {
      this.#structure = structure;
      this.#createParts(block, controls);
    }
    controls.forEach((control, index) => this.#parts[index].update(control));
    const drawn = /** @type {HTMLElement} */ (this.large.firstElementChild);
    drawn.innerHTML = picture(block);
    this.plain.hidden = controls.length > 0;
    setAttribute(this.element, "data-words", sentence(block, this.options.t));
  }

  /** @param {Block} block @param {Control[]} controls */
  #createParts(block, controls) {
    const { t, endSeries } = this.options;
    this.#parts = controls.map(({ kind }, index) => {
      const control = () => controlsOf(/** @type {Block} */ (this.#block), this.#mode)[index];
      return partOf(kind, { t, control, use: (value) => this.#use(index, value), endSeries });
    });
    const inPicture = this.#parts.filter((_, index) => "area" in controls[index]).map((part) => part.element);
    const beside = this.#parts.filter((_, index) => !("area" in controls[index])).map((part) => part.element);
    this.large.replaceChildren(h("div", { class: "vpl-drawn", "aria-hidden": "true" }), ...inPicture);
    this.large.hidden = block.name === "sound";
    this.body.replaceChildren(this.large, ...beside);
  }

  /** @param {number} index  among the controls @param {number} [value] */
  #use(index, value) {
    if (this.#block === null) return;
    const control = controlsOf(this.#block, this.#mode)[index];
    const series = control.kind === "slider" ? `${index} ${this.#button?.getAttribute("data-place")}` : "";
    this.options.change(used(this.#block, control, this.#mode, value), series);
  }
}
