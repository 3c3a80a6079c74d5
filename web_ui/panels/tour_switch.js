// The button that opens the tour again.

import { h, setAttribute } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function tourSwitchPanel({ t, tour }) {
  const element = h(
    "button",
    {
      type: "button",
      id: "tour-switch",
      title: t("tour.open"),
      "aria-label": t("tour.open"),
      onclick: () => (tour.isOpen ? tour.close() : void tour.open()),
    },
    "?",
  );
  return { slot: "header", element, render: () => setAttribute(element, "aria-pressed", String(tour.isOpen)) };
}
