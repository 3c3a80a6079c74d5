// What things snap to: a grid of 1 to 10 cm, on its lines or in the middle of its squares, or nothing.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";
import { GRID_SIZES } from "./snap.js";

/** @param {import("../i18n/index.js").Translate} t @param {import("./creator_model.js").CreatorModel} model */
export function snapMenu(t, model) {
  /** @param {number | null} size  meters; null: nothing snaps */
  const label = (size) => (size === null ? t("bar.snapOff") : t("bar.snap", { size: size * 100 }));
  const word = h("span", { class: "word" });
  const button = h("button", { type: "button", class: "select quiet", id: "creator-snap" }, icon("grid", { small: true }), word, icon("caretDown", { small: true }));
  const sizes = [...GRID_SIZES, null].map((size) => {
    const input = h("input", { type: "radio", name: "creator-snap", value: size ?? "off" });
    input.addEventListener("change", () => model.setGrid(size === null ? { isOff: true } : { size, isOff: false }));
    return { size, input, row: h("label", { class: "check" }, input, h("span", {}, label(size))) };
  });
  const centers = h("input", { type: "checkbox", "data-verb": "centers" });
  centers.addEventListener("change", () => model.setGrid({ on: centers.checked ? "centers" : "lines" }));
  const sheet = h(
    "div",
    { id: "creator-snap-sheet", role: "group", "aria-label": t("bar.snapTitle") },
    ...sizes.map(({ row }) => row),
    h("hr"),
    h("label", { class: "check" }, centers, h("span", {}, t("bar.centers"))),
  );
  makeSheet(button, sheet, { opened: () => sizes.find(({ input }) => input.checked)?.input.focus(), closed: () => button.focus() });
  return {
    element: h("span", { class: "menu" }, button, sheet),
    render() {
      const { size, on, isOff = false } = model.grid;
      const now = isOff ? null : size;
      setText(word, label(now));
      for (const one of sizes) one.input.checked = one.size === now;
      centers.checked = on === "centers";
      centers.disabled = isOff;
    },
  };
}
