// Why something was refused, for people: a headline, then where, what was found, and what was expected.

import { h } from "./dom.js";

/** @typedef {{ place: string, found: string, expected: string }} Refusal */

/** The parts of a refusal's text; null for one that is said otherwise. @param {string} text @returns {Refusal | null} */
export function refusalOf(text) {
  const match = /^(?:([\s\S]*?): )?found ([\s\S]*?), expected ([\s\S]*)$/.exec(text);
  return match === null ? null : { place: match[1] ?? "", found: match[2], expected: match[3] };
}

/** @param {import("../i18n/index.js").Translate} t @param {string} headline @param {import("../state/index.js").Fault | null} fault */
export function faultView(t, headline, fault) {
  const head = h("p", { class: "headline" }, headline);
  if (fault === null) return [head];
  const at = fault.line === null ? "" : t("fault.at", { line: fault.line, column: fault.column ?? 1 });
  const refusal = refusalOf(fault.text);
  if (refusal === null) return [head, h("p", {}, [at, fault.text].filter(Boolean).join(": "))];
  const place = [at, refusal.place].filter(Boolean).join(", ");
  const rows = [
    ["fault.place", place || t("fault.file")],
    ["fault.found", refusal.found],
    ["fault.expected", refusal.expected],
  ].map(([key, text]) => h("div", {}, h("dt", {}, t(key)), h("dd", {}, text)));
  return [head, h("dl", {}, ...rows)];
}
