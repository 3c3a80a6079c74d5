// The robot's five buttons as a cross; a button is shown as pressed when the robot reports it.

import { disabledReason } from "../state/disabled_reason.js";
import { BUTTONS } from "../state/names.js";
import { h, lock, momentary, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../shell/context.js").Context} context */
export function buttonPad({ text, actions }) {
  const t = text("stage");
  const pageText = text("page");
  const buttons = BUTTONS.map((name) => {
    const label = t(`button.${name}`);
    const button = h(
      "button",
      { type: "button", class: `btn ${name}`, "data-button": name, "aria-label": label, title: label },
      icon(/** @type {import("../ui/icons.js").IconName} */ (name)),
    );
    momentary(button, (pressed) => actions.pressPad(name, pressed));
    return { name, button };
  });
  return {
    element: h("div", { class: "pad", id: "pad", role: "group", "aria-label": t("pad") }, ...buttons.map(({ button }) => button)),
    /** @param {import("../state/index.js").State} state */
    render({ connection, readOnly, robots, selected }) {
      for (const { name, button } of buttons) {
        setAttribute(button, "aria-pressed", String(robots[selected]?.buttons[name] ?? false));
        lock(button, disabledReason({ connection, readOnly }, pageText));
      }
    },
  };
}
