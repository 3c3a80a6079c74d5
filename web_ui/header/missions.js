// The button with the list of missions. In narrow windows the menu "?" has it.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function missionsPanel({ mission, text }) {
  const label = text("page")("missions");
  const attributes = { type: "button", class: "btn", id: "missions-open", onclick: () => void mission.openList() };
  return { slot: "header", element: h("button", attributes, icon("flag"), h("span", {}, label)) };
}
