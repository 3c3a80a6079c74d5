// The state of a program as text: state, line, and fault message (docs/aseba_ros.md, _aseba/status).

/** @typedef {Readonly<Record<string, string>>} Values  of the status message */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const KNOWN = ["running", "paused", "stopped", "fault", "off"];
/** States in which the robot stands in a line. */
const PLACED = ["paused", "fault"];

/** @param {string} state @param {Translate} t @param {boolean} [timePaused]  whether the simulation is paused */
export function stateLabel(state, t, timePaused = false) {
  if (timePaused && state === "running") return t("state.timePaused");
  return t(KNOWN.includes(state) ? `state.${state}` : "state.unknown");
}

/** The line in the program's own text, from 1; 0: none. @param {Values} values */
export function lineOf(values) {
  return values.line ? Math.max(0, Number(values.line) - (Number(values.first_line) || 1) + 1) : 0;
}

/**
 * The state with the line in which the program is halted or failed.
 *
 * @param {Values} values
 * @param {Translate} t
 * @param {boolean} [timePaused]
 */
export function stateWithLine(values, t, timePaused = false) {
  const { state = "" } = values;
  const line = lineOf(values);
  return line > 0 && PLACED.includes(state) ? t(`state.${state}At`, { line }) : stateLabel(state, t, timePaused);
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
