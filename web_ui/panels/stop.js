// The stop button, always visible.

import { h, icon, ICONS, lock } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function stopPanel({ t, actions }) {
  const element = h(
    "button",
    { type: "button", class: "stop", title: t("stop.help"), "data-drives": "", onclick: () => actions.stop() },
    icon(ICONS.stop),
    t("stop"),
  );
  return {
    slot: "header",
    element,
    render: ({ connection }) => lock(element, connection === "connected" ? "" : t("connection.needed")),
  };
}
