// What a node prints, below its text, and how it has ended.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** Distance from the end, in px, within which the console follows it. */
const NEAR_PX = 24;

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {() => void} options.clear
 * @param {() => void} options.go   goes to the line of the error
 */
export function nodeConsole({ t, clear, go }) {
  const title = h("b", { id: "python-console-title" }, t("python.output"));
  const state = h("span", { class: "chip", id: "python-state" });
  const button = h("button", { type: "button", class: "btn note", "data-verb": "clear", onclick: clear }, t("python.clear"));
  const words = h("span", {});
  const error = h("button", { type: "button", class: "python-error", hidden: true, onclick: go }, icon("warning", { small: true }), words);
  const text = h("pre", { class: "python-output", tabindex: "0", "aria-labelledby": title.id });
  const element = h(
    "section",
    { class: "python-console", "aria-labelledby": title.id },
    h("div", { class: "python-console-head" }, title, state, h("span", { class: "grow" }), button),
    error,
    text,
  );
  let shown = "";
  return {
    element,
    /**
     * @param {object} facts
     * @param {string} facts.output
     * @param {string} facts.now     what the node does, "" for none
     * @param {string} facts.tone    of the chip
     * @param {string} facts.mistake   "" for none
     */
    render({ output, now, tone, mistake }) {
      setText(state, now);
      setText(words, mistake);
      error.hidden = mistake === "";
      setAttribute(state, "class", `chip ${tone}`.trim());
      state.hidden = now === "";
      button.hidden = output === "";
      if (output === shown) return;
      const isAtEnd = text.scrollTop + text.clientHeight >= text.scrollHeight - NEAR_PX;
      if (output.startsWith(shown)) text.append(output.slice(shown.length));
      else text.textContent = output;
      shown = output;
      if (isAtEnd) text.scrollTop = text.scrollHeight;
    },
  };
}
