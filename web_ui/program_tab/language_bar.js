// What happens to the picture or the blocks of a document that is shown as text: a line above the program.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("./language_choice.js").LanguageChoice} LanguageChoice */

/**
 * @param {object} options
 * @param {import("../i18n/index.js").Translate} options.t
 * @param {LanguageChoice} options.choice
 * @param {() => void} options.detach   makes the document a text
 * @param {() => void} options.changed  the document may be shown in another language now
 */
export function languageBar({ t, choice, detach, changed }) {
  const element = h("div", { class: "program-language", role: "group", "aria-label": t("language"), hidden: true });
  /** @param {string} key @param {string} look @param {() => void} act */
  const button = (key, look, act) =>
    h("button", { type: "button", class: `btn note ${look}`, "data-detach": key, onclick: act }, t(`detach.${key}`));
  /** @param {() => void} act */
  const then = (act) => () => {
    act();
    changed();
  };
  const buttons = {
    made: () => [button("turn", "line", detach)],
    detached: () => [
      button("undo", "line", then(() => choice.undo())),
      button("done", "", then(() => choice.settle())),
    ],
    ask: () => [
      button("back", "line", then(() => choice.undo())),
      button("keep", "", then(() => choice.keepText())),
    ],
  }; // prettier-ignore
  let shown = "";
  return {
    element,
    render() {
      const { notice } = choice;
      const now = notice === null ? "" : `${notice.kind} ${notice.language}`;
      if (now === shown) return;
      shown = now;
      element.hidden = notice === null;
      if (notice === null) return;
      element.replaceChildren(
        icon(notice.kind === "made" ? "text" : "warning", { small: true }),
        h("span", { class: "grow" }, t(`detach.${notice.kind}.text`, { language: t(`language.${notice.language}`) })),
        ...buttons[notice.kind](),
      );
      if (notice.kind === "ask") /** @type {HTMLElement | null} */ (element.querySelector("button"))?.focus();
    },
  };
}
