// Displays the reason of a rejection: headline, location, what was found, and what was expected.

import { h } from "../ui/dom.js";

/** @typedef {{ place: string, found: string, expected: string }} Refusal */

/**
 * Split the text of a rejection into its parts; null if it has another form.
 *
 * @param {string} text
 * @returns {Refusal | null}
 */
export function refusalOf(text) {
  const match = /^(?:([\s\S]*?): )?found ([\s\S]*?), expected ([\s\S]*)$/.exec(text);
  return match === null ? null : { place: match[1] ?? "", found: match[2], expected: match[3] };
}

/** Expectations that only a file of another kind violates. */
const FOREIGN = /^(?:JSON\b.*|XML|UTF-8 text|an object|<aseba-playground>|a complete zip archive|a plain zip archive)$/s;

/**
 * Whether a rejected file is of another kind, rather than a playground with an error.
 *
 * @param {Refusal | null} refusal
 */
export function isForeign(refusal) {
  if (refusal === null) return false;
  const { place, expected } = refusal;
  return place === "format" || (FOREIGN.test(expected) && /^(?:line \d+(?:, column \d+)?)?$/.test(place));
}

/**
 * A rejected playground in one sentence.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {import("../state/index.js").Fault | null} fault
 */
export function faultText(t, fault) {
  if (fault === null) return "";
  return isForeign(refusalOf(fault.text)) ? t("fault.notPlayground") : fault.text;
}

/**
 * A file of another kind: one plain sentence; the details can be expanded.
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
