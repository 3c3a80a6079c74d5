// What was probably meant where the compiler refuses a text, and the button that corrects it.

import { h, setText } from "../panels/dom.js";

/** @typedef {import("./checking.js").Repair} Repair */

const LONGEST = 14; // letters that a button shows

/**
 * What a repair does to a text, for its button.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {string} text
 * @param {Repair} repair
 */
export function repairLabel(t, text, { from, to, insert }) {
  const old = text.slice(from, to).trim();
  const now = insert.trim();
  /** @param {string} word */
  const isShort = (word) => word.length <= LONGEST && !word.includes("\n");
  if (!isShort(old) || !isShort(now) || /\s/.test(old) || (old === "" && now === "")) return t("hint.correct");
  if (now === "") return t("hint.remove", { old });
  return old === "" ? t("hint.insert", { now }) : t("hint.change", { now });
}

/** @param {import("../i18n/index.js").Translate} t @param {() => void} correct */
export function hintBar(t, correct) {
  const words = h("span", { class: "meant" });
  const button = h("button", { type: "button", class: "correct", title: t("hint.key"), onclick: correct });
  const element = h("div", { class: "editor-hint", hidden: true }, words, button);
  return {
    element,
    /** @param {{ text: string, button: string } | null} hint  without words on the button there is none */
    show(hint) {
      element.hidden = hint === null;
      setText(words, hint?.text ?? "");
      setText(button, hint?.button ?? "");
      button.hidden = !hint?.button;
    },
  };
}
