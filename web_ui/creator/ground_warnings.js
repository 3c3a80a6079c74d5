// Warnings about a playground that is accepted but probably not meant: items outside the ground, or no ground at all.

import { h, setText } from "../ui/dom.js";
import { itemsOffGround, lacksGround } from "../playground/validation.js";
import { withGround } from "./commands.js";

/** @param {import("../i18n/index.js").Translate} t @param {import("./creator_model.js").CreatorModel} model */
export function groundWarnings(t, model) {
  const outside = h("p", { class: "note-box wait", hidden: true });
  const add = () => model.replacePlayground(withGround(model.playground), { word: "change.ground" });
  const missing = h(
    "div",
    { class: "note-box wait", role: "status", hidden: true },
    h("p", { class: "grow" }, t("warning.noGround")),
    h("button", { type: "button", class: "btn line", "data-verb": "ground", onclick: add }, t("warning.addGround")),
  );
  /** @type {import("../playground/document.js").Playground | null} */ let checked = null;
  return {
    elements: [outside, missing],
    render() {
      if (model.playground === checked) return;
      checked = model.playground;
      const names = itemsOffGround(checked.items).map((item) => item.name);
      outside.hidden = names.length === 0;
      missing.hidden = !lacksGround(checked.items);
      setText(outside, names.length === 0 ? "" : t("warning.outside", { names: names.join(", ") }));
    },
  };
}
