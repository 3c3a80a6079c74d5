// The text that is made from the blocks, read-only; the lines of the selected row are marked.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { pieces } from "./marked_text.js";

/** @typedef {import("../generator.js").Source} Source */

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {() => void} options.turn     makes the program a text
 * @param {(line: number) => void} options.choose   a line was clicked, from 1
 */
export function textPane({ t, turn, choose }) {
  const about = h("small", { class: "muted" });
  const code = h("pre", { class: "vpl-code", tabindex: "0", role: "region", "aria-label": t("pane.title") });
  code.addEventListener("click", ({ target }) => {
    const line = target instanceof Element ? target.closest("[data-line]") : null;
    if (line instanceof HTMLElement) choose(Number(line.dataset.line));
  });
  const button = h("button", { type: "button", class: "btn note", "data-vpl": "turn", onclick: turn }, t("pane.turn"));
  const element = h(
    "section",
    { class: "vpl-text" },
    h("div", { class: "vpl-text-head" }, h("b", {}, t("pane.title")), about, h("span", { class: "grow" }), button),
    code,
  );
  let shown = "";
  let marked = "";
  return {
    element,
    /** @param {{ isShown: boolean, text: string, source: Source | null, row: number | null }} facts */
    render({ isShown, text, source, row }) {
      if (element.hidden === isShown) element.hidden = !isShown;
      if (!isShown) return;
      const lines = row === null ? null : (source?.rows[row] ?? null);
      setText(about, lines === null || row === null ? t("pane.readOnly") : t("pane.marked", { row: row + 1 }));
      if (text !== shown || code.childElementCount === 0) {
        shown = text;
        marked = "";
        code.replaceChildren(...(text.trim() === "" ? [h("span", { class: "muted" }, t("pane.empty"))] : lined(text)));
      }
      const now = lines === null ? "" : `${lines.first} ${lines.last}`;
      if (now === marked) return;
      marked = now;
      const all = /** @type {HTMLElement[]} */ ([...code.children]);
      all.forEach((line, index) => {
        const isMarked = lines !== null && lines.first <= index + 1 && index + 1 <= lines.last;
        setAttribute(line, "class", isMarked ? "marked" : "");
      });
      const first = lines === null ? undefined : all[lines.first - 1];
      if (first !== undefined) code.scrollTop = first.offsetTop - code.offsetTop - 8;
    },
  };
}

/** @param {string} text */
function lined(text) {
  return text
    .trimEnd()
    .split("\n")
    .map((line, index) => {
      const words = pieces(line.replaceAll("\t", "  ")).map(({ text: part, look }) =>
        look === "" ? part : h("span", { class: `vpl-code-${look}` }, part),
      );
      return h("span", { "data-line": index + 1 }, ...words, "\n");
    });
}
