// Below the view: undo and redo, camera, grid; and what is going on.

import { h, icon, setAttribute, setText } from "../panels/dom.js";
import { CREATOR_ICONS } from "./icons.js";
import { GRID_SIZES } from "./snap.js";

/** @param {import("../i18n/index.js").Translate} t @param {import("./builder.js").Builder} builder */
export function bar(t, builder) {
  /** @param {string} name @param {() => void} act */
  const button = (name, act) =>
    h(
      "button",
      { type: "button", "data-verb": name, title: t(`bar.${name}`), "aria-label": t(`bar.${name}`), onclick: act },
      icon(CREATOR_ICONS[name]),
    );
  const undo = button("undo", () => builder.undo());
  const redo = button("redo", () => builder.redo());
  const camera = button("camera", () => builder.toggleCamera());
  camera.append(t("bar.cameraWord"));
  const size = h("select", { "aria-label": t("bar.grid"), "data-verb": "grid" });
  size.append(...GRID_SIZES.map((metres) => h("option", { value: metres }, `${metres * 100} cm`)));
  size.addEventListener("change", () => builder.setGrid({ size: Number(size.value) }));
  const on = h("select", { "aria-label": t("bar.snap"), "data-verb": "snap" });
  on.append(...["lines", "centres"].map((choice) => h("option", { value: choice }, t(`bar.${choice}`))));
  on.addEventListener("change", () => builder.setGrid({ on: /** @type {"lines" | "centres"} */ (on.value) }));
  const told = h("output", { class: "told" });
  const element = h(
    "div",
    { class: "creator-bar", role: "toolbar", "aria-label": t("bar") },
    undo,
    redo,
    camera,
    h("span", { class: "grid-word" }, t("bar.gridWord")),
    size,
    on,
    told,
  );
  return {
    element,
    /** @param {string} text */
    tell: (text) => setText(told, text),
    render() {
      const { history, placing, grid, cameraOn } = builder;
      undo.disabled = history.past.length === 0 && (placing?.points.length ?? 0) === 0;
      redo.disabled = history.future.length === 0 && (placing?.takenBack.length ?? 0) === 0;
      setAttribute(camera, "aria-pressed", String(cameraOn));
      size.value = String(grid.size);
      on.value = grid.on;
    },
  };
}
