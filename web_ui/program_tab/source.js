// A source text with line numbers and one error marked: the line, the column, and the message below it.

import { h } from "../ui/dom.js";

const TAB = 4;

/** @param {string} text @param {import("../state/index.js").Fault} fault @param {string} label */
export function sourceView(text, fault, label) {
  const lines = text.split(/\r\n|\r|\n/);
  const rows = lines.map((line, index) => {
    const marked = index + 1 === fault.line;
    const row = h(
      "div",
      { class: marked ? "line marked" : "line" },
      h("span", { class: "gutter" }, String(index + 1)),
      h("code", {}, line || " "),
    );
    if (!marked) return row;
    const before = line.slice(0, Math.max(0, (fault.column ?? 1) - 1));
    const caret = h(
      "div",
      { class: "caret" },
      h("span", { class: "gutter", "aria-hidden": "true" }),
      h("code", { "aria-hidden": "true" }, before.replace(/[^\t]/g, " "), h("b", {}, "▲")),
    );
    const words = h(
      "div",
      { class: "words" },
      h("span", { class: "gutter", "aria-hidden": "true" }),
      h("span", {}, fault.text),
    );
    return h("div", { class: "fault" }, row, caret, words);
  });
  const element = h(
    "div",
    { class: "source", tabindex: "0", role: "region", "aria-label": label, style: `tab-size: ${TAB}` },
    ...rows,
  );
  // Scroll to the error once the element has a size.
  requestAnimationFrame(() => {
    const marked = /** @type {HTMLElement | null} */ (element.querySelector(".fault"));
    const caret = /** @type {HTMLElement | null} */ (element.querySelector(".caret b"));
    if (marked === null || caret === null) return;
    element.scrollTop = marked.offsetTop - element.clientHeight / 2 + marked.offsetHeight / 2;
    const overshoot = caret.offsetLeft + caret.offsetWidth - element.clientWidth;
    if (overshoot > 0) element.scrollLeft = overshoot + element.clientWidth / 3;
  });
  return element;
}
