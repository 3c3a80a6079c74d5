// The stop button, always visible.

import { disabledReason } from "../state/disabled_reason.js";
import { h, icon, ICONS, lock } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function stopPanel({ t, actions }) {
  const element = h(
    "button",
    { type: "button", class: "stop", title: t("stop.help"), onclick: () => actions.stop() },
    icon(ICONS.stop),
    t("stop"),
  );
  return {
    slot: "header",
    element,
    render: ({ connection, readOnly }) => lock(element, disabledReason({ connection, readOnly }, t)),
  };
}
