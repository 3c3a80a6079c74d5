// What a hand does to the robot: icons with names beside the pad; those with values open a sheet.

import { disabledReason } from "../../state/disabled_reason.js";
import { h } from "../../ui/dom.js";
import { foldedList } from "../../ui/folded_list.js";
import { icon } from "../../ui/icons.js";
import { fitNames } from "../../ui/names_fit.js";
import { clapHand, liftHand, tapHand } from "./at_once.js";
import { frontHand } from "./front_hand.js";
import { penHand } from "./pen.js";
import { remoteHand } from "./remote.js";
import { roomHand } from "./room.js";
import { tiltHand } from "./tilt.js";

/**
 * @typedef {object} Hand
 * @property {HTMLElement} element
 * @property {(state: import("../../state/index.js").State, reason: string) => void} render   reason: why it is disabled
 */

/**
 * @param {import("../../shell/context.js").Context} context
 * @param {HTMLButtonElement} fold   the button that folds the tray
 */
export function hands(context, fold) {
  const { text, frame } = context;
  const t = text("stage");
  const pageText = text("page");
  const first = [tapHand, clapHand, liftHand, frontHand, tiltHand].map((create) => create(context));
  const rest = [penHand, remoteHand, roomHand].map((create) => create(context));
  const more = h(
    "button",
    { type: "button", class: "hand quiet", "data-hand": "more", id: "hands-more" },
    icon("more"),
    h("span", {}, pageText("more")),
  );
  const list = h(
    "div",
    { class: "hands-rest", id: "hands-rest", role: "group", "aria-label": pageText("more") },
    ...rest.map(({ element }) => element),
    fold,
  );
  const setFolded = foldedList(more, list);
  const grid = h("div", { class: "hand-grid" }, ...first.map(({ element }) => element), more, list);
  const names = () => [...grid.querySelectorAll(".hand > span")];
  const fit = fitNames(
    grid,
    () => (frame.layout === "phone" ? ["below"] : ["beside", "below"]),
    () => names().every((name) => name.scrollWidth <= name.clientWidth),
  );
  return {
    element: h(
      "div",
      { class: "hands", id: "hands", role: "group", "aria-label": t("hands") },
      h("span", { class: "cap", "aria-hidden": "true" }, t("hands")),
      grid,
    ),
    /** @param {import("../../state/index.js").State} state */
    render(state) {
      const isPhone = frame.layout === "phone";
      if (isPhone !== list.classList.contains("sheet")) {
        setFolded(isPhone);
        fit();
      }
      const reason = disabledReason(state, pageText);
      for (const hand of [...first, ...rest]) hand.render(state, reason);
    },
  };
}
