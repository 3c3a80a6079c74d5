// The state of a program as text: state, line, and fault message (docs/aseba_ros.md, _aseba/status).

/** @typedef {Readonly<Record<string, string>>} Values  of the status message */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const KNOWN = ["running", "paused", "stopped", "fault", "off"];

/** @param {string} state @param {Translate} t @param {boolean} [timePaused]  whether the simulation is paused */
export function stateLabel(state, t, timePaused = false) {
  if (timePaused && state === "running") return t("state.runningPaused");
  return t(KNOWN.includes(state) ? `state.${state}` : "state.unknown");
}

/** The line in the program's own text, from 1; 0: none. @param {Values} values */
export function lineOf(values) {
  return values.line ? Math.max(0, Number(values.line) - (Number(values.first_line) || 1) + 1) : 0;
}

/** The line at which it is stopped, in parentheses; empty while it runs. @param {Values} values @param {Translate} t */
export function lineLabel(values, t) {
  const line = lineOf(values);
  return line > 0 && values.state !== "running" ? ` (${t("state.line", { line })})` : "";
}

/**
 * The fault message, translated if the runtime has a translation; empty without a fault.
 *
 * @param {Values} values
 * @param {string} language
 */
export function faultMessage(values, language) {
  return JSON.parse(values.faults || "{}")[language] ?? values.fault ?? "";
}
