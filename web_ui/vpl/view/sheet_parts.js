// The parts of the editor of a block: one for each control. A part is created once and then shows what the control is now.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { COLUMNS, lengthAt, NOTES } from "./controls.js";
import { HEIGHT, WIDTH } from "./shapes.js";

/** @typedef {import("./controls.js").Control} Control */
/** @typedef {import("./controls.js").Words} Words */
/** @typedef {{ element: HTMLElement, update: (control: any) => void }} Part */
/**
 * @template {Control} C
 * @typedef {object} PartOptions
 * @property {import("../../i18n/index.js").Translate} t
 * @property {() => C} control    as it is now
 * @property {(value?: number) => void} use
 * @property {() => void} endSeries   the gesture is over
 */

/**
 * The part of a control.
 *
 * @param {Control["kind"]} kind
 * @param {PartOptions<any>} options
 * @returns {Part}
 */
export function partOf(kind, options) {
  return MAKERS[kind](options);
}

/** A label as text. @param {import("../../i18n/index.js").Translate} t @param {Words} words */
function textOf(t, { key, values = {} }) {
  return t(key, "part" in values ? { ...values, part: t(String(values.part)) } : values);
}

/** @param {PartOptions<import("./controls.js").PressControl>} options @returns {Part} */
function pressPart({ t, control, use }) {
  const { x, y, width, height } = control().area;
  const style =
    `left: ${(100 * x) / WIDTH}%; top: ${(100 * y) / HEIGHT}%; ` +
    `width: ${(100 * width) / WIDTH}%; height: ${(100 * height) / HEIGHT}%`;
  const element = h("button", { type: "button", class: "vpl-part", style, onclick: () => use() });
  return {
    element,
    update({ words, isOn }) {
      setAttribute(element, "aria-label", textOf(t, words));
      setAttribute(element, "title", textOf(t, words));
      setAttribute(element, "aria-pressed", String(isOn));
    },
  };
}

/** @param {PartOptions<import("./controls.js").SliderControl>} options @returns {Part} */
function sliderPart({ t, control, use, endSeries }) {
  const { look, words } = control();
  const shown = h("output", {});
  const input = h("input", { type: "range", min: 0, step: 1 });
  input.addEventListener("input", () => use(control().stops[Number(input.value)]));
  input.addEventListener("change", endSeries);
  return {
    element: h("label", { class: "vpl-slider", "data-look": look }, h("span", {}, textOf(t, words)), input, shown),
    update({ stops, value, shown: read }) {
      setAttribute(input, "max", String(stops.length - 1));
      const at = String(stops.indexOf(value));
      if (input.value !== at) input.value = at;
      setAttribute(input, "aria-valuetext", textOf(t, read));
      setText(shown, textOf(t, read));
    },
  };
}

/** @param {PartOptions<import("./controls.js").ChoiceControl>} options @returns {Part} */
function choicePart({ t, control, use }) {
  const { options, words } = control();
  const buttons = options.map(({ value, words: name }) =>
    h(
      "button",
      { type: "button", class: "btn note", "data-value": value, onclick: () => use(value) },
      textOf(t, name),
    ),
  );
  return {
    element: h("div", { class: "seg vpl-choice", role: "group", "aria-label": textOf(t, words) }, ...buttons),
    update({ value }) {
      for (const each of buttons) setAttribute(each, "aria-pressed", String(Number(each.dataset.value) === value));
    },
  };
}

/** The melody. @param {PartOptions<import("./controls.js").NotesControl>} options @returns {Part} */
function notesPart({ t, use }) {
  const cells = Array.from({ length: COLUMNS * NOTES }, (_, at) => {
    const column = at % COLUMNS;
    const note = NOTES - 1 - Math.floor(at / COLUMNS); // high notes are on top
    const words = t("note.at", { column: column + 1, note: note + 1 });
    const attributes = { type: "button", class: "vpl-note", "data-note": column * NOTES + note, title: words };
    return h("button", { ...attributes, onclick: () => use(column * NOTES + note) }, h("i", {}));
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
}

/** @type {Record<Control["kind"], (options: PartOptions<any>) => Part>} */
const MAKERS = { press: pressPart, key: pressPart, slider: sliderPart, choice: choicePart, notes: notesPart };
