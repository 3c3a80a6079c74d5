// Warnings about a playground that is accepted but not meant: items outside the ground, no ground at all, or items that
// the simulator cannot build.

import { h, setText } from "../ui/dom.js";
import { answerCount } from "../playground/kinds/generic.js";
import { itemsOffGround, lacksGround, problemsIn } from "../playground/validation.js";
import { withGround } from "./commands.js";

/** @param {import("../playground/labels.js").Labels} labels @param {import("./creator_model.js").CreatorModel} model */
export function warnings(labels, model) {
  const { t } = labels;
  const faults = h("p", { class: "note-box wait", role: "status", hidden: true });
  const outside = h("p", { class: "note-box wait", hidden: true });
  const add = () => model.replacePlayground(withGround(model.playground), { word: "change.ground" });
  const missing = h(
    "div",
    { class: "note-box wait", role: "status", hidden: true },
    h("p", { class: "grow" }, t("warning.noGround")),
    h("button", { type: "button", class: "btn line", "data-verb": "ground", onclick: add }, t("warning.addGround")),
  );
  /** @type {import("../playground/document.js").Playground | null} */ let checked = null;
  let answers = 0;
  return {
    elements: [faults, outside, missing],
    render() {
      if (model.playground === checked && answers === answerCount) return;
      checked = model.playground;
      answers = answerCount;
      const lines = problemsIn(checked.items).map(({ name, problem }) => `${name}: ${labels.text(problem)}`);
      faults.hidden = lines.length === 0;
      setText(faults, lines.join(" "));
      const names = itemsOffGround(checked.items).map((item) => item.name);
      outside.hidden = names.length === 0;
      missing.hidden = !lacksGround(checked.items);
      setText(outside, names.length === 0 ? "" : t("warning.outside", { names: names.join(", ") }));
    },
  };
}
