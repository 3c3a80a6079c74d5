// A slider with its value and unit beside it.

import { h } from "../../ui/dom.js";

/** @typedef {{ name: string, label: string, low: number, high: number, step: number, unit: string }} Range */

/**
 * @param {Range} range
 * @param {(value: number) => void} change
 */
export function slider({ name, label, low, high, step, unit }, change) {
  const input = h("input", { type: "range", min: low, max: high, step, "data-operate": name });
  const shown = h("output");
  /** @param {number} value */
  const say = (value) => {
    shown.textContent = `${value} ${unit}`;
    input.setAttribute("aria-valuetext", shown.textContent);
  };
  input.addEventListener("input", () => {
    say(Number(input.value));
    change(Number(input.value));
  });
  return {
    element: h("label", { class: "slider" }, h("span", {}, label), input, shown),
    /** @param {number} value */
    show(value) {
      input.value = String(value);
      say(value);
    },
  };
}
