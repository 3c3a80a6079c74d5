// Whether the page can act on the simulator.

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
