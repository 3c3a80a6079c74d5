// A form row to add an event or constant: name, number, button; errors are shown in place.

import { h, setText } from "../../ui/dom.js";
import { WORD } from "../help.js";
import { parseNumbers } from "../numbers.js";

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {"event" | "constant"} options.kind
 * @param {number} options.least
 * @param {number} options.greatest
 * @param {string} options.label   label of the number
 * @param {(name: string, value: number) => void} options.add
 */
export function entryForm({ t, kind, least, greatest, label, add }) {
  const name = h("input", {
    type: "text",
    "aria-label": t(`${kind}.name`),
    placeholder: t(`${kind}.name`),
    "data-new": kind,
  });
  const value = h("input", {
    type: "text",
    inputmode: "numeric",
    "aria-label": label,
    placeholder: label,
    class: "number",
  });
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  const form = h("form", { class: "entry" }, name, value, h("button", { type: "submit", class: "btn line note slim" }, t("add")), errorText);
  /** @param {string} text */
  const showError = (text) => {
    errorText.hidden = text === "";
    setText(errorText, text);
  };
  form.addEventListener("submit", (event) => {
    event.preventDefault();
    const word = name.value.trim();
    if (new RegExp(`^${WORD.source}$`, "u").exec(word) === null || /^[0-9]/.test(word))
      return showError(t("name.bad", { name: word }));
    const { values, problem } = parseNumbers(value.value || "0", 1, least, greatest);
    if (values === null) return showError(t(problem.key, problem.values));
    showError("");
    add(word, values[0]);
    name.value = value.value = "";
    name.focus();
  });
  return form;
}
