// The "?" of the header: what explains the page.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { menu } from "../ui/menu.js";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function helpMenuPanel({ text, tour }) {
  const t = text("page");
  const button = h(
    "button",
    { type: "button", class: "btn icon", id: "help-open", title: t("help"), "aria-label": t("help") },
    icon("help"),
  );
  const { element } = menu({
    id: "help-menu",
    button,
    label: t("help"),
    entries: () => [
      { label: t("help.tour"), icon: "idea", attributes: { "data-help": "tour" }, act: () => void tour.open() },
    ],
  });
  return { slot: "header", element };
}
