// Whether the page can act on the simulator, and on its time.

import { PARAMETERS } from "./names.js";

/**
 * Why controls that act on the simulator are disabled; empty: they are enabled.
 *
 * @param {Pick<import("./index.js").State, "connection" | "readOnly">} state
 * @param {import("../i18n/index.js").Translate} t
 */
export function disabledReason({ connection, readOnly }, t) {
  if (connection !== "connected") return t("connection.needed");
  return readOnly ? t("access.readOnlyHelp") : "";
}

/**
 * Why controls of time are disabled besides that; empty: they are enabled. A teacher's pause holds (docs/classroom.md).
 *
 * @param {Pick<import("./index.js").State, "parameters">} state
 * @param {import("../i18n/index.js").Translate} t
 */
export function timeDisabledReason({ parameters }, t) {
  return parameters[PARAMETERS.pausedByTeacher] === true ? t("time.pausedByTeacher") : "";
}
