// The hint over the view while an item is placed or dragged: what to do next, or why the position is taken; with buttons
// for those without a keyboard.

import { h, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { canTurn } from "./place.js";

/** @typedef {import("./placing.js").Placing} Placing */

/**
 * @param {object} options
 * @param {import("../playground/labels.js").Labels} options.labels
 * @param {import("./creator_model.js").CreatorModel} options.model
 * @param {HTMLElement} options.canvas   gets the focus back, so that keys act on the view
 */
export function placingHint({ labels, model, canvas }) {
  const { t } = labels;
  /** @param {() => void} act */
  const thenFocusView = (act) => () => {
    act();
    canvas.focus();
  };
  const hint = h("p", { class: "note-box placing-hint" });
  const finish = h(
    "button",
    { type: "button", class: "btn you finish", onclick: thenFocusView(() => model.placing?.finish()) },
    icon("check"),
    t("hint.finish"),
  );
  const cancel = h(
    "button",
    { type: "button", class: "btn line cancel", onclick: thenFocusView(() => model.cancel()) },
    t("hint.cancel"),
  );
  const turn = h(
    "button",
    { type: "button", class: "btn line turn", title: t("action.turnLeft"), onclick: thenFocusView(() => model.turn(1)) },
    icon("turn", { small: true }),
    t("act.turn"),
  );
  const element = h("div", { class: "placing-hints" }, hint, finish, turn, cancel);

  const text = () => {
    const { placing } = model;
    const problem = model.ghost?.problem ?? null;
    if (problem !== null) return labels.text(problem);
    if (placing === null) return "";
    return labels.text({ word: wordOf(placing), values: { kind: placing.kind } });
  };

  return {
    element,
    render() {
      const { placing } = model;
      setText(hint, text());
      hint.classList.toggle("invalid", (model.ghost?.problem ?? null) !== null);
      element.hidden = hint.textContent === "";
      finish.hidden = placing?.pathKey === undefined || placing.points.length < 2;
      turn.hidden = placing === null || placing.isPath || !canTurn(placing.pattern);
      cancel.hidden = placing === null;
    },
  };
}

/**
 * The key of the hint: that of the kind if it has one, else that of the way in which it is placed.
 *
 * @param {Placing} placing
 */
function wordOf({ kind, isPath, pathKey }) {
  if (!isPath) return "hint.placing";
  if (kind === "track" || kind === "wall") return `hint.${kind}`;
  return pathKey === undefined ? "hint.ends" : "hint.path";
}
