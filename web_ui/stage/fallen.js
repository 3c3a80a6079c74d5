// A message over the view for each fallen robot, with a button that returns it to its start.

import { robotNames } from "../browser/robot_names.js";
import { h } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function fallenPanel({ text, actions }) {
  const t = text("stage");
  const pageText = text("page");
  const element = h("div", { class: "fallen", role: "status" });
  let shown = "";
  return {
    slot: "messages",
    element,
    render({ connection, robots, simulator }) {
      const fallen = connection === "connected" ? (simulator?.fallen ?? []) : [];
      if (fallen.join() === shown && element.childElementCount === fallen.length) return;
      shown = fallen.join();
      const several = Object.keys(robots).length > 1;
      /** @param {string} name */
      const words = (name) =>
        several ? t("fallen.named", { name: robotNames.title(name) || pageText("app.robot") }) : t("fallen");
      const messages = fallen.map((name) =>
        h(
          "p",
          { class: "message" },
          h("span", { class: "grow" }, words(name)),
          h(
            "button",
            { type: "button", class: "btn soft", "data-fallen": name, onclick: () => void actions.putBack(name) },
            t("fallen.back"),
          ),
        ),
      );
      keepFocus(
        element,
        () => element.replaceChildren(...messages),
        () => element.querySelector("button"),
      );
    },
  };
}
