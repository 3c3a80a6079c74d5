// Shows why a playground was rejected: one sentence that a pupil understands; the technical line behind "Details".
// Loaded when it is needed: it has the names of all fields.

import WORDS from "../i18n/creator.texts.js";
import { translator } from "../i18n/index.js";
import { Labels } from "../playground/labels.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { sentenceOf } from "./reasons.js";

export { reasonOfFault, reasonOfMessage } from "./reasons.js";

/** @typedef {import("./reasons.js").Reason} Reason */

/** A reason in one sentence. @param {string} language @param {Reason} reason */
export function refusalText(language, reason) {
  return sentenceOf(new Labels(language, translator(language, WORDS)), reason);
}

/**
 * @param {string} language
 * @param {string} headline   what was not opened
 * @param {Reason | null} reason
 */
export function refusalView(language, headline, reason) {
  const head = h("p", { class: "headline" }, icon("warning"), headline);
  if (reason === null) return [head];
  const t = translator(language, WORDS);
  return [
    head,
    h("p", { class: "reason" }, refusalText(language, reason)),
    h(
      "details",
      { class: "technical" },
      h("summary", {}, t("fault.details")),
      h("p", { lang: "en" }, reason.technical),
    ),
  ];
}
