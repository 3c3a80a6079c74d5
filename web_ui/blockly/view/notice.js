// What the user should know about the open file, above the blocks: its text is another one, it cannot be shown, or
// parts of it were left out.

import { h } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { fileProblemText } from "../messages.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */
/** @typedef {import("./document.js").BlocksDocument} BlocksDocument */

/**
 * @param {object} options
 * @param {Translate} options.t      of blockly.json
 * @param {() => void} options.adopt   makes the text from the blocks
 */
export function fileNotice({ t, adopt }) {
  const element = h("div", { class: "blocks-notice", role: "status", hidden: true });

  /** @param {string} text @param {readonly Node[]} more @param {readonly string[]} details */
  const show = (text, more, details) => {
    const list = h("ul", {}, ...details.map((each) => h("li", {}, each)));
    const summary = h("summary", {}, t("view.more", { count: details.length }));
    const unfolded = h("details", { class: "blocks-more" }, summary, list);
    element.replaceChildren(
      icon("warning", { small: true }),
      h("div", { class: "grow" }, h("p", {}, text), ...(details.length === 0 ? [] : [unfolded])),
      ...more,
    );
    element.hidden = false;
  };
  /** @param {string} name @param {string} text @param {string} look @param {() => void} act */
  const button = (name, text, look, act) =>
    h("button", { type: "button", class: `btn note ${look}`, "data-notice": name, onclick: act }, text);

  return {
    element,
    /**
     * @param {BlocksDocument} document
     * @param {readonly string[]} leftOut   what an import left out
     */
    render(document, leftOut) {
      const { file, difference } = document;
      const [problem] = file.problems;
      element.hidden = true;
      if (problem !== undefined) {
        const [first, ...others] = file.problems.map((each) => {
          const { line, column } = each;
          return t("view.at", { line, column, text: fileProblemText(each, t) });
        });
        show(`${t("view.unknown")} ${first}`, [], others);
      } else if (difference !== null) {
        show(t("view.other"), [button("adopt", t("view.adopt"), "line", adopt)], [t("view.difference", difference)]);
      } else if (leftOut.length > 0) {
        show(t("view.leftOut"), [button("close", t("view.ok"), "", () => (element.hidden = true))], leftOut);
      }
    },
  };
}
