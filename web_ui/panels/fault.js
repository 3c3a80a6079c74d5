// Why something was refused, for people: a headline, then where, what was found, and what was expected.

import { h } from "./dom.js";

/** @typedef {{ place: string, found: string, expected: string }} Refusal */

/** The parts of a refusal's text; null for one that is said otherwise. @param {string} text @returns {Refusal | null} */
export function refusalOf(text) {
  const match = /^(?:([\s\S]*?): )?found ([\s\S]*?), expected ([\s\S]*)$/.exec(text);
  return match === null ? null : { place: match[1] ?? "", found: match[2], expected: match[3] };
}

/** Expectations of the readers that only a file of another kind misses. */
const FOREIGN = /^(?:JSON\b.*|XML|UTF-8 text|an object|<aseba-playground>|a whole one|a plain zip archive)$/s;

/** Whether a refused file is of another kind, rather than a playground with a mistake. @param {Refusal | null} refusal */
export function isForeign(refusal) {
  if (refusal === null) return false;
  const { place, expected } = refusal;
  return place === "format" || (FOREIGN.test(expected) && /^(?:line \d+(?:, column \d+)?)?$/.test(place));
}

/** A refused playground in one sentence. @param {import("../i18n/index.js").Translate} t @param {import("../state/index.js").Fault | null} fault */
export function faultText(t, fault) {
  if (fault === null) return "";
  return isForeign(refusalOf(fault.text)) ? t("fault.notPlayground") : fault.text;
}

/**
 * A file of another kind: pupils read a sentence, and who wants to know more opens the details.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {string} headline
 * @param {string} technical
 */
export function foreignView(t, headline, technical) {
  return [
    h("p", { class: "headline" }, headline),
    h("p", {}, t("fault.notPlayground")),
    h("details", {}, h("summary", {}, t("fault.details")), h("p", { class: "technical" }, technical)),
  ];
}

/** @param {import("../i18n/index.js").Translate} t @param {string} headline @param {import("../state/index.js").Fault | null} fault */
export function faultView(t, headline, fault) {
  const head = h("p", { class: "headline" }, headline);
  if (fault === null) return [head];
  const at = fault.line === null ? "" : t("fault.at", { line: fault.line, column: fault.column ?? 1 });
  const refusal = refusalOf(fault.text);
  if (refusal === null) return [head, h("p", {}, [at, fault.text].filter(Boolean).join(": "))];
  if (isForeign(refusal)) return foreignView(t, headline, [at, fault.text].filter(Boolean).join(": "));
  const place = [at, refusal.place].filter(Boolean).join(", ");
  const rows = [
    ["fault.place", place || t("fault.file")],
    ["fault.found", refusal.found],
    ["fault.expected", refusal.expected],
  ].map(([key, text]) => h("div", {}, h("dt", {}, t(key)), h("dd", {}, text)));
  return [head, h("dl", {}, ...rows)];
}
