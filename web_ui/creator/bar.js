// The bar below the view: undo and redo, camera, grid, and the latest status message.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { GRID_SIZES } from "./snap.js";

/** @param {import("../i18n/index.js").Translate} t @param {import("./creator_model.js").CreatorModel} model */
export function bar(t, model) {
  /** @param {"undo" | "redo" | "camera"} name @param {() => void} act */
  const button = (name, act) =>
    h(
      "button",
      { type: "button", class: "btn line slim", "data-verb": name, title: t(`bar.${name}`), "aria-label": t(`bar.${name}`), onclick: act },
      icon(name),
    );
  const undo = button("undo", () => model.undo());
  const redo = button("redo", () => model.redo());
  const camera = button("camera", () => model.toggleCamera());
  camera.append(h("span", { class: "word" }, t("bar.cameraLabel")));
  const size = h("select", { class: "select quiet", "aria-label": t("bar.grid"), "data-verb": "grid" });
  size.append(...GRID_SIZES.map((meters) => h("option", { value: meters }, `${meters * 100} cm`)));
  size.addEventListener("change", () => model.setGrid({ size: Number(size.value) }));
  const on = h("select", { class: "select quiet", "aria-label": t("bar.snap"), "data-verb": "snap" });
  on.append(...["lines", "centers"].map((choice) => h("option", { value: choice }, t(`bar.${choice}`))));
  on.addEventListener("change", () => model.setGrid({ on: /** @type {"lines" | "centers"} */ (on.value) }));
  const output = h("output", { class: "status" });
  const element = h(
    "div",
    { class: "creator-bar", role: "toolbar", "aria-label": t("bar") },
    undo,
    redo,
    camera,
    h("span", { class: "grid-word" }, t("bar.gridLabel")),
    size,
    on,
    output,
  );
  return {
    element,
    /** @param {string} text */
    report: (text) => setText(output, text),
    render() {
      const { history, placing, grid, cameraOn } = model;
      undo.disabled = history.past.length === 0 && (placing?.points.length ?? 0) === 0;
      redo.disabled = history.future.length === 0 && (placing?.undonePoints.length ?? 0) === 0;
      setAttribute(camera, "aria-pressed", String(cameraOn));
      size.value = String(grid.size);
      on.value = grid.on;
    },
  };
}
