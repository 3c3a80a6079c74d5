// What the user must know or decide, above the rows: an older text, blocks that a mode lacks, a file that cannot be read.

import { h } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";

/**
 * @typedef {object} Notice
 * @property {string} text
 * @property {readonly string[]} [items]   a list below it
 * @property {string} [about]              a line between the text and the list
 * @property {"wait" | "stop"} look
 * @property {readonly { name: string, text: string, isMain?: boolean, act: () => void }[]} buttons
 */

export function noticeList() {
  const element = h("div", { class: "vpl-notices" });
  /** @type {Map<string, { key: string, element: HTMLElement }>} */ const shown = new Map();

  /** @param {Notice} notice */
  const draw = ({ text, about, items = [], look, buttons }) =>
    h(
      "div",
      { class: `note-box ${look}`, role: "group" },
      icon("warning", { small: true }),
      h(
        "div",
        { class: "vpl-notice" },
        h("b", {}, text),
        ...(about === undefined ? [] : [h("p", {}, about)]),
        ...(items.length === 0 ? [] : [h("ul", {}, ...items.map((item) => h("li", {}, item)))]),
        h(
          "div",
          { class: "row" },
          ...buttons.map(({ name, text: words, isMain = false, act }) =>
            h("button", { type: "button", class: `btn note ${isMain ? "you" : "line"}`, "data-answer": name, onclick: act }, words),
          ),
        ),
      ),
    ); // prettier-ignore

  return {
    element,
    /** Show a notice, or none. Returns whether it is a new one. @param {string} id @param {Notice | null} notice */
    set(id, notice) {
      const key = JSON.stringify(notice);
      const old = shown.get(id);
      if (old?.key === key || (old === undefined && notice === null)) return false;
      old?.element.remove();
      shown.delete(id);
      if (notice === null) return false;
      const added = draw(notice);
      element.append(added);
      shown.set(id, { key, element: added });
      return true;
    },
    /** @param {string} id */
    focus(id) {
      const button = shown.get(id)?.element.querySelector("button");
      button?.scrollIntoView({ block: "nearest" });
      button?.focus();
    },
  };
}
