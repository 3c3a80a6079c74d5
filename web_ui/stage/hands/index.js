// What a hand does to the robot: buttons beside the pad; those with values open a sheet.

import { disabledReason } from "../../state/disabled_reason.js";
import { h, lock } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { moreStimuli } from "./more.js";

/** @param {import("../../shell/context.js").Context} context */
export function hands(context) {
  const { text, actions } = context;
  const t = text("stage");
  const pageText = text("page");
  /** @param {"tap" | "clap"} name @param {() => void} act */
  const hand = (name, act) =>
    h(
      "button",
      { type: "button", class: "hand", "data-hand": name, "data-operate": name, onclick: act },
      icon(name),
      h("span", {}, t(`stimuli.${name}`)),
    );
  const tap = hand("tap", () => actions.operate("_press/tap", "std_msgs/msg/Empty", {}));
  const clap = hand("clap", () => actions.operate("_press/clap", "std_msgs/msg/Float32", { data: 1 }));
  const more = moreStimuli(context);
  const grid = h("div", { class: "hand-grid" }, tap, clap, more.element);
  return {
    element: h("div", { class: "hands", id: "hands", role: "group", "aria-label": t("stimuli") }, grid),
    grid,
    /** @param {import("../../state/index.js").State} state */
    render(state) {
      for (const button of [tap, clap]) lock(/** @type {HTMLButtonElement} */ (button), disabledReason(state, pageText));
      more.render(state);
    },
  };
}
