// The robot's five buttons as a cross; a button shows as pressed when the robot says so.

import { BUTTONS } from "../state/names.js";
import { h, holdable, icon, ICONS, lock, setAttribute } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function dpadPanel({ t, actions, store }) {
  const buttons = BUTTONS.map((name) => {
    const label = t(`button.${name}`);
    const button = h(
      "button",
      { type: "button", class: `pad ${name}`, "data-button": name, "aria-label": label, title: label },
      icon(name === "center" ? ICONS.dot : ICONS.arrow),
    );
    holdable(button, (pressed) => actions.press(store.state.selected, name, pressed));
    return { name, button };
  });
  const element = h(
    "div",
    { class: "dpad", role: "group", "aria-label": t("dpad") },
    ...buttons.map(({ button }) => button),
  );
  return {
    slot: "stage",
    element,
    render({ connection, robots, selected }) {
      for (const { name, button } of buttons) {
        setAttribute(button, "aria-pressed", String(robots[selected]?.buttons[name] ?? false));
        lock(button, connection === "connected" ? "" : t("connection.needed"));
      }
    },
  };
}
