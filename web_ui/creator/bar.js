// The bar below the view: undo and redo, what things snap to, and the latest status message.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { snapMenu } from "./snap_menu.js";

/** @param {import("../playground/labels.js").Labels} labels @param {import("./creator_model.js").CreatorModel} model */
export function bar({ t }, model) {
  /** @param {"undo" | "redo"} name @param {() => void} act */
  const button = (name, act) =>
    h(
      "button",
      { type: "button", class: "btn icon", "data-verb": name, title: t(`bar.${name}`), "aria-label": t(`bar.${name}`), onclick: act },
      icon(name),
    );
  const undo = button("undo", () => model.undo());
  const redo = button("redo", () => model.redo());
  const snap = snapMenu(t, model);
  const output = h("output", { class: "status" });
  const element = h(
    "div",
    { class: "creator-bar", role: "toolbar", "aria-label": t("bar") },
    undo,
    redo,
    h("span", { class: "vline" }),
    snap.element,
    output,
  );
  return {
    element,
    /** @param {string} text */
    report: (text) => setText(output, text),
    render() {
      const { history, placing } = model;
      undo.disabled = history.past.length === 0 && (placing?.points.length ?? 0) === 0;
      redo.disabled = history.future.length === 0 && (placing?.undonePoints.length ?? 0) === 0;
      snap.render();
    },
  };
}
