// The program that blocks stand for, below them: read only. The lines of the selected block are marked, and a click on
// a line selects its block.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { pieces } from "../../vpl/view/marked_text.js";

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t  of blockly.json
 * @param {string} options.turnText
 * @param {() => void} options.turn        makes the program a text
 * @param {(line: number) => void} options.choose   a line was clicked, from 0
 */
export function textPanel({ t, turnText, turn, choose }) {
  const note = h("span", { class: "small muted" });
  const code = h("ol", { class: "blocks-code", tabindex: "0", "aria-label": t("view.same") });
  code.addEventListener("click", ({ target }) => {
    const line = target instanceof Element ? target.closest("li") : null;
    if (line !== null) choose([...code.children].indexOf(line));
  });
  const element = h(
    "section",
    { class: "blocks-text", "aria-labelledby": "blocks-text-title", hidden: true },
    h(
      "div",
      { class: "blocks-text-head" },
      h("b", { id: "blocks-text-title" }, t("view.same")),
      note,
      h("span", { class: "grow" }),
      h("button", { type: "button", class: "btn note", "data-verb": "turn", onclick: turn }, turnText),
    ),
    code,
  );
  /** @type {string | null} */ let shown = null;
  return {
    element,
    /**
     * @param {object} facts
     * @param {string} facts.program
     * @param {{ first: number, last: number } | null} facts.selected   lines of the selected block, from 0
     * @param {number | null} facts.running   the line in which the program is halted
     */
    render({ program, selected, running }) {
      setText(note, selected === null ? t("view.readOnly") : t("view.marked"));
      if (program !== shown) {
        shown = program;
        const lines = program.trimEnd() === "" ? [] : program.trimEnd().split(/\r\n|\r|\n/);
        code.replaceChildren(...lines.map(lineOf));
      }
      /** @type {Element | null} */ let wanted = null;
      [...code.children].forEach((line, index) => {
        const isSelected = selected !== null && index >= selected.first && index <= selected.last;
        const mark = index === running ? "running" : isSelected ? "selected" : "";
        if (mark !== (line.getAttribute("data-mark") ?? "") && mark !== "") wanted ??= line;
        setAttribute(line, "data-mark", mark);
      });
      if (wanted !== null && !element.hidden) scrollTo(code, wanted);
    },
  };
}

/** @param {string} line */
function lineOf(line) {
  const words = pieces(line.replaceAll("\t", "  "));
  const colored = words.map(({ look, text }) => (look === "" ? text : h("span", { class: `blocks-${look}` }, text)));
  return h("li", {}, h("code", {}, ...colored));
}

/** Scroll a list, and nothing around it, until a line is in view. @param {HTMLElement} list @param {Element} line */
function scrollTo(list, line) {
  const place = line.getBoundingClientRect();
  const frame = list.getBoundingClientRect();
  if (place.top < frame.top) list.scrollTop -= frame.top - place.top;
  else if (place.bottom > frame.bottom) list.scrollTop += place.bottom - frame.bottom;
}
