// The editor of a block: its picture, large, with parts that can be pressed, and sliders and choices around it. There is
// one sheet; each change takes effect at once.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { nameKey } from "../blocks.js";
import { COLUMNS, controlsOf, lengthAt, NOTES, used } from "./controls.js";
import { move, openBeside } from "./open_beside.js";
import { picture } from "./picture.js";
import { sentence } from "./sentences.js";
import { HEIGHT, WIDTH } from "./shapes.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../kinds.js").Mode} Mode */
/** @typedef {import("./controls.js").Control} Control */
/** @typedef {import("./controls.js").Words} Words */
/** @typedef {{ element: HTMLElement, update: (control: any) => void }} Part */

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {(block: Block, series: string) => void} options.change
 * @param {() => void} options.endSeries   the gesture is over
 * @param {() => void} options.copy
 * @param {() => void} options.remove
 * @param {() => void} options.closed
 */
export function blockSheet({ t, change, endSeries, copy, remove, closed }) {
  /** @type {Block | null} */ let block = null;
  /** @type {Mode} */ let mode = "basic";
  /** @type {Element | null} */ let button = null;
  /** @type {Part[]} */ let parts = [];
  let structure = "";
  const title = h("h3", { id: "vpl-block-title" });
  const large = h("div", { class: "vpl-large" });
  const body = h("div", { class: "vpl-sheet-body" });
  const plain = h("p", { class: "small muted" }, t("block.plain"));
  /**
   * @param {string} name
   * @param {import("../../ui/icons.js").IconName} sign
   * @param {string} look
   * @param {() => void} act
   */
  const action = (name, sign, look, act) =>
    h(
      "button",
      { type: "button", class: `btn note ${look}`, "data-block-verb": name, onclick: act },
      icon(sign, { small: true }),
      t(`block.${name}`),
    );
  const close = () => element.hidePopover();
  const element = h(
    "div",
    {
      id: "vpl-block",
      class: "sheet vpl-sheet",
      popover: "auto",
      role: "dialog",
      "aria-labelledby": "vpl-block-title",
    },
    title,
    body,
    plain,
    h(
      "div",
      { class: "row vpl-sheet-foot" },
      action("copy", "copy", "line", () => (close(), copy())),
      action("remove", "remove", "line", () => (close(), remove())),
      h("span", { class: "grow" }),
      action("done", "check", "you", close),
    ),
  );
  element.addEventListener("toggle", () => {
    if (element.matches(":popover-open")) return;
    block = null;
    endSeries();
    closed();
  });

  /** @param {Words} words */
  const say = ({ key, values = {} }) =>
    t(key, "part" in values ? { ...values, part: t(String(values.part)) } : values);

  /** @param {Control} control @param {number} index  among the controls @param {number} [value] */
  const use = (control, index, value) => {
    if (block === null) return;
    const series = control.kind === "slider" ? `${index} ${button?.getAttribute("data-place")}` : "";
    change(used(block, control, mode, value), series);
  };

  /** @param {() => Control} control @param {number} index @returns {Part} */
  const pressable = (control, index) => {
    const first = /** @type {import("./controls.js").PressControl} */ (control());
    const { x, y, width, height } = first.area;
    const style =
      `left: ${(100 * x) / WIDTH}%; top: ${(100 * y) / HEIGHT}%; ` +
      `width: ${(100 * width) / WIDTH}%; height: ${(100 * height) / HEIGHT}%`;
    const element = h("button", { type: "button", class: "vpl-part", style, onclick: () => use(control(), index) });
    return {
      element,
      update({ words, isOn }) {
        setAttribute(element, "aria-label", say(words));
        setAttribute(element, "title", say(words));
        setAttribute(element, "aria-pressed", String(isOn));
      },
    };
  };

  /** @param {() => Control} control @param {number} index @returns {Part} */
  const sliding = (control, index) => {
    const { look, words } = /** @type {import("./controls.js").SliderControl} */ (control());
    const shown = h("output", {});
    const input = h("input", { type: "range", min: 0, step: 1 });
    const stops = () => /** @type {import("./controls.js").SliderControl} */ (control()).stops;
    input.addEventListener("input", () => use(control(), index, stops()[Number(input.value)]));
    input.addEventListener("change", endSeries);
    return {
      element: h("label", { class: "vpl-slider", "data-look": look }, h("span", {}, say(words)), input, shown),
      update({ stops: all, value, shown: read }) {
        setAttribute(input, "max", String(all.length - 1));
        const at = String(all.indexOf(value));
        if (input.value !== at) input.value = at;
        setAttribute(input, "aria-valuetext", say(read));
        setText(shown, say(read));
      },
    };
  };

  /** @param {() => Control} control @param {number} index @returns {Part} */
  const choosing = (control, index) => {
    const { options, words } = /** @type {import("./controls.js").ChoiceControl} */ (control());
    const buttons = options.map(({ value, words: name }) =>
      h(
        "button",
        { type: "button", class: "btn note", "data-value": value, onclick: () => use(control(), index, value) },
        say(name),
      ),
    );
    return {
      element: h("div", { class: "seg vpl-choice", role: "group", "aria-label": say(words) }, ...buttons),
      update({ value }) {
        for (const each of buttons) setAttribute(each, "aria-pressed", String(Number(each.dataset.value) === value));
      },
    };
  };

  /** @param {() => Control} control @param {number} index @returns {Part} */
  const melody = (control, index) => {
    const cells = Array.from({ length: COLUMNS * NOTES }, (_, at) => {
      const column = at % COLUMNS;
      const note = NOTES - 1 - Math.floor(at / COLUMNS); // high notes are on top
      const words = t("note.at", { column: column + 1, note: note + 1 });
      const attributes = { type: "button", class: "vpl-note", "data-note": column * NOTES + note, title: words };
      return h("button", { ...attributes, onclick: () => use(control(), index, column * NOTES + note) }, h("i", {}));
    });
    return {
      element: h(
        "div",
        { class: "vpl-notes-part" },
        h("div", { class: "vpl-notes", role: "group", "aria-label": t("block.sound") }, ...cells),
        h("p", { class: "small muted" }, t("note.help")),
      ),
      update({ values }) {
        for (const cell of cells) {
          const at = Number(cell.dataset.note);
          const note = at % NOTES;
          const length = lengthAt(values[Math.floor(at / NOTES)], note);
          const words = t("note.at", { column: Math.floor(at / NOTES) + 1, note: note + 1 });
          setAttribute(cell, "data-length", length);
          setAttribute(cell, "aria-pressed", String(length !== ""));
          setAttribute(cell, "aria-label", length === "long" ? t("note.long", { note: words }) : words);
        }
      },
    };
  };

  /** @type {Record<Control["kind"], (control: () => Control, index: number) => Part>} */
  const MAKERS = { press: pressable, key: pressable, slider: sliding, choice: choosing, notes: melody };

  const draw = () => {
    if (block === null) return;
    const controls = controlsOf(block, mode);
    const now = JSON.stringify([block.name, controls.map((each) => [each.kind, "area" in each ? each.area : 0])]);
    setText(title, t(nameKey(block)));
    setAttribute(element, "data-block", block.name);
    if (now !== structure) {
      structure = now;
      /** @param {number} index */
      const present = (index) => controlsOf(/** @type {Block} */ (block), mode)[index];
      parts = controls.map(({ kind }, index) => MAKERS[kind](() => present(index), index));
      const inPicture = parts.filter((_, index) => "area" in controls[index]).map((part) => part.element);
      const beside = parts.filter((_, index) => !("area" in controls[index])).map((part) => part.element);
      const drawn = h("div", { class: "vpl-drawn", "aria-hidden": "true" });
      large.replaceChildren(drawn, ...inPicture);
      large.hidden = block.name === "sound";
      body.replaceChildren(large, ...beside);
    }
    controls.forEach((control, index) => parts[index].update(control));
    const drawn = /** @type {HTMLElement} */ (large.firstElementChild);
    drawn.innerHTML = picture(block);
    plain.hidden = controls.length > 0;
    setAttribute(element, "data-words", sentence(block, t));
  };

  return {
    element,
    close,
    get isOpen() {
      return block !== null;
    },
    /** Edit a block beside its button. @param {Block} opened @param {Mode} inMode @param {Element} beside */
    open(opened, inMode, beside) {
      [block, mode, button] = [opened, inMode, beside];
      structure = "";
      draw();
      openBeside(element, beside);
      /** @type {HTMLElement | null} */ (body.querySelector("button, input") ?? element.querySelector(".you"))?.focus();
    },
    /** The block has changed. @param {Block | null} changed @param {Mode} inMode @param {Element | null} beside */
    update(changed, inMode, beside) {
      if (block === null || changed === block) return;
      if (changed === null || changed.name !== block.name) return close();
      const old = structure;
      const { activeElement } = document;
      const focused = activeElement instanceof HTMLElement && element.contains(activeElement) ? activeElement : null;
      const value = focused?.dataset.value;
      [block, mode, button] = [changed, inMode, beside ?? button];
      draw();
      if (old === structure) return;
      if (button !== null) move(element, button);
      const next = value === undefined ? "button, input" : `[data-value="${value}"]`;
      /** @type {HTMLElement | null} */ (body.querySelector(next))?.focus();
    },
  };
}
