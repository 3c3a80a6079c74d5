// The hint bar: what was probably meant where the compiler reports an error, with a button that corrects it.

import { h, setText } from "../ui/dom.js";

/** @typedef {import("./checking.js").Repair} Repair */

const LONGEST = 14; // maximum number of letters on a button

/**
 * The button label of a repair.
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
    /** @param {{ text: string, button: string } | null} hint  without button text there is no button */
    show(hint) {
      element.hidden = hint === null;
      setText(words, hint?.text ?? "");
      setText(button, hint?.button ?? "");
      button.hidden = !hint?.button;
    },
  };
}
