// Blockly's questions, such as that for the name of a new variable, as dialogs of the page.

import { h } from "../../ui/dom.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */

/**
 * Ask a question. Escape and a click beside the dialog answer null.
 *
 * @param {object} options
 * @param {Translate} options.t  of blockly.json
 * @param {string} options.question
 * @param {string} [options.initial]   what the field has at first; without it there is none
 * @param {string} [options.yes]
 * @param {string | null} [options.no]   null: there is nothing to choose
 * @returns {Promise<string | null>}   what is in the field, or ""
 */
export function ask({ t, question, initial, yes = t("view.ok"), no = t("view.cancel") }) {
  return new Promise((resolve) => {
    const field = h("input", { class: "input", value: initial ?? "", autocomplete: "off", spellcheck: "false" });
    const accept = h("button", { type: "submit", class: "btn you", value: "yes" }, yes);
    const cancel = h("button", { type: "submit", class: "btn", value: "no", formnovalidate: true }, no ?? "");
    const words = h("span", { class: "blocks-question", id: "blocks-question" }, question);
    const form = h(
      "form",
      { method: "dialog" },
      initial === undefined ? words : h("label", { class: "field" }, words, field),
      h("div", { class: "blocks-answers" }, accept, ...(no === null ? [] : [cancel])),
    );
    const dialog = h("dialog", { class: "blocks-dialog", "aria-labelledby": "blocks-question" }, form);
    dialog.addEventListener("click", (event) => event.target === dialog && dialog.close());
    dialog.addEventListener("keydown", (event) => event.stopPropagation()); // keys are for the field, not for blocks
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(dialog.returnValue === "yes" ? field.value : null);
    });
    document.body.append(dialog);
    dialog.showModal();
    if (initial === undefined) accept.focus();
    else field.select();
  });
}

/**
 * @param {typeof import("blockly/core")} blockly
 * @param {Translate} t
 */
export function useDialogs(blockly, t) {
  blockly.dialog.setPrompt((question, initial, answer) => void ask({ t, question, initial }).then(answer));
  blockly.dialog.setConfirm((question, answer) => void ask({ t, question }).then((given) => answer(given !== null)));
  blockly.dialog.setAlert((question, closed) => void ask({ t, question, no: null }).then(() => closed?.()));
}
