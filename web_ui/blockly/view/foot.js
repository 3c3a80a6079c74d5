// The foot of the blocks: how many mistakes there are, or what became of a command.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";

/** @typedef {"good" | "warning" | "error" | ""} Kind */

/** @type {Readonly<Record<Kind, import("../../ui/icons.js").IconName | null>>} */
const SIGNS = { good: "check", warning: "warning", error: "warning", "": null };

/** @param {() => void} go  leads to the first mistake */
export function blocksFoot(go) {
  const sign = h("span", { class: "blocks-sign", "aria-hidden": "true" });
  const words = h("span", {});
  const verdict = h("button", { type: "button", class: "blocks-verdict", hidden: true, onclick: go }, sign, words);
  /** @type {Kind | null} */ let shown = null;
  return {
    element: h("div", { class: "blocks-foot" }, verdict),
    /** @param {string} text @param {Kind} kind */
    report(text, kind) {
      setText(words, text);
      verdict.hidden = text === "";
      if (kind === shown) return;
      shown = kind;
      setAttribute(verdict, "data-kind", kind);
      const name = SIGNS[kind];
      sign.replaceChildren(...(name === null ? [] : [icon(name, { small: true })]));
    },
  };
}
