// A message over the view for each fallen robot, with a button that returns it to its start.

import { h } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function fallenPanel({ t, actions }) {
  const element = h("div", { class: "fallen", role: "status" });
  let shown = "";
  return {
    slot: "stage",
    element,
    render({ connection, robots, simulator }) {
      const fallen = connection === "connected" ? (simulator?.fallen ?? []) : [];
      if (fallen.join() === shown && element.childElementCount === fallen.length) return;
      shown = fallen.join();
      const several = Object.keys(robots).length > 1;
      element.replaceChildren(
        ...fallen.map((name) =>
          h(
            "p",
            {},
            h("span", {}, several ? t("fallen.named", { name: name || t("app.robot") }) : t("fallen")),
            h(
              "button",
              { type: "button", "data-fallen": name, onclick: () => void actions.putBack(name) },
              t("fallen.back"),
            ),
          ),
        ),
      );
    },
  };
}
