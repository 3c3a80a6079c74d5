// Tabs that choose the robot for the panels; hidden if there is only one robot.

import { robotColor } from "../state/robot_colors.js";
import { h, setAttribute } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function robotsPanel({ t, store }) {
  const element = h("div", { class: "robots", role: "group", "aria-label": t("robot") });
  /** @type {string | null} */ let shown = null;
  return {
    slot: "side",
    element,
    render({ robots, selected }) {
      const names = Object.keys(robots);
      if (names.join() !== shown) {
        shown = names.join();
        element.hidden = names.length < 2;
        element.replaceChildren(
          ...names.map((name) =>
            h(
              "button",
              { type: "button", "data-robot": name, style: `--color: ${robotColor(names, name)}`, onclick: () => store.dispatch({ type: "select", robot: name }) },
              name || t("app.robot"),
            ),
          ),
        );
      }
      for (const button of element.children)
        setAttribute(button, "aria-pressed", String(button.getAttribute("data-robot") === selected));
    },
  };
}
