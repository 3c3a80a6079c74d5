// The text that rows or blocks stand for, below them: read only. The lines of what is selected are marked, and a click
// on a line selects what it is made from.

import { h, setAttribute, setText } from "../ui/dom.js";
import { pieces } from "./marked_text.js";

/** @typedef {{ first: number, last: number }} Lines   from 0 */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t   of editor.json
 * @param {string} [options.empty]                  stands where there is no text yet
 * @param {() => void} options.turn                 makes the program a text
 * @param {(line: number) => void} options.choose   a line was clicked, from 0
 */
export function textPane({ t, empty = "", turn, choose }) {
  const note = h("span", { class: "small muted" });
  const code = h("ol", { class: "program-code", tabindex: "0", "aria-label": t("pane.title") });
  code.addEventListener("click", ({ target }) => {
    const line = target instanceof Element ? target.closest("li") : null;
    if (line !== null) choose([...code.children].indexOf(line));
  });
  const title = h("b", { id: "program-text-title" }, t("pane.title"));
  const button = h("button", { type: "button", class: "btn note", "data-verb": "turn", onclick: turn }, t("detach.turn"));
  const element = h(
    "section",
    { class: "program-text", "aria-labelledby": title.id, hidden: true },
    h("div", { class: "program-text-head" }, title, note, h("span", { class: "grow" }), button),
    code,
  );
  /** @type {string | null} */ let shown = null;
  return {
    element,
    /**
     * @param {object} facts
     * @param {boolean} facts.isShown
     * @param {string} facts.text
     * @param {Lines | null} facts.selected
     * @param {string} facts.about               what is selected
     * @param {number | null} [facts.running]    the line in which the program is halted
     */
    render({ isShown, text, selected, about, running = null }) {
      if (element.hidden === isShown) element.hidden = !isShown;
      if (!isShown) return;
      setText(note, selected === null ? t("pane.readOnly") : `${about} ${t("pane.readOnly")}`);
      if (text !== shown) {
        shown = text;
        const lines = text.trimEnd() === "" ? [] : text.trimEnd().split(/\r\n|\r|\n/);
        code.replaceChildren(...(lines.length > 0 ? lines.map(lineOf) : [h("li", { class: "muted" }, empty)]));
      }
      /** @type {Element | null} */ let wanted = null;
      [...code.children].forEach((line, index) => {
        const isSelected = selected !== null && index >= selected.first && index <= selected.last;
        const mark = index === running ? "running" : isSelected ? "selected" : "";
        if (mark !== (line.getAttribute("data-mark") ?? "") && mark !== "") wanted ??= line;
        setAttribute(line, "data-mark", mark);
      });
      if (wanted !== null) scrollTo(code, wanted);
    },
  };
}

/** @param {string} line */
function lineOf(line) {
  const words = pieces(line.replaceAll("\t", "  "));
  const colored = words.map(({ look, text }) =>
    look === "" ? text : h("span", { class: `program-code-${look}` }, text),
  );
  return h("li", {}, h("code", {}, ...colored));
}

/** Scroll a list, and nothing around it, until a line is in view. @param {HTMLElement} list @param {Element} line */
function scrollTo(list, line) {
  const place = line.getBoundingClientRect();
  const frame = list.getBoundingClientRect();
  if (place.top < frame.top) list.scrollTop -= frame.top - place.top;
  else if (place.bottom > frame.bottom) list.scrollTop += place.bottom - frame.bottom;
}
