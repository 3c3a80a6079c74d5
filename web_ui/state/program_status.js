// Where a program stands, in words: state, line, and why it failed (docs/aseba_ros.md, _aseba/status).

/** @typedef {Readonly<Record<string, string>>} Values  of the status */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const KNOWN = ["running", "paused", "stopped", "fault", "off"];

/** @param {string} state @param {Translate} t @param {boolean} [timePaused]  a program that runs waits for time then */
export function stateLabel(state, t, timePaused = false) {
  if (timePaused && state === "running") return t("state.runningPaused");
  return t(KNOWN.includes(state) ? `state.${state}` : "state.unknown");
}

/** The line of the program's own text that the status names, from 1; 0: none. @param {Values} values */
export function lineOf(values) {
  return values.line ? Math.max(0, Number(values.line) - (Number(values.first_line) || 1) + 1) : 0;
}

/** Where it waits or failed, in brackets; nothing while it runs. @param {Values} values @param {Translate} t */
export function lineLabel(values, t) {
  const line = lineOf(values);
  return line > 0 && values.state !== "running" ? ` (${t("state.line", { line })})` : "";
}

/** Why it failed, in a language if the runtime speaks it; empty when it has not. @param {Values} values @param {string} language */
export function faultMessage(values, language) {
  return JSON.parse(values.faults || "{}")[language] ?? values.fault ?? "";
}
