// The button that opens and closes the playground creator.

import { h, icon, setAttribute } from "./dom.js";

const BRICKS = "M3 4h8v5H3zM13 4h8v5h-8zM3 11h4v5H3zM9 11h6v5H9zM17 11h4v5h-4zM3 18h8v3H3zM13 18h8v3h-8z";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function creatorSwitchPanel({ t, creator }) {
  const element = h(
    "button",
    {
      type: "button",
      id: "creator-switch",
      title: t("creator.help"),
      onclick: () => (creator.isOpen ? creator.close() : void creator.open()),
    },
    icon(BRICKS),
    h("span", {}, t("creator")),
  );
  return { slot: "header", element, render: () => setAttribute(element, "aria-pressed", String(creator.isOpen)) };
}
