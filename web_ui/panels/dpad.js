// The robot's five buttons as a cross; a button is shown as pressed when the robot reports it.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { BUTTONS } from "../state/names.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, momentary, icon, ICONS, lock, setAttribute } from "./dom.js";

const CHEVRON = "M4 8.500 5.800 6.700 12 12.900l6.200-6.200L20 8.500l-8 8z";
/** Storage key: whether the pad is hidden on small screens. */
const FOLDED_KEY = "padFolded";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function dpadPanel({ t, actions, store }) {
  const buttons = BUTTONS.map((name) => {
    const label = t(`button.${name}`);
    const button = h(
      "button",
      { type: "button", class: `pad ${name}`, "data-button": name, "aria-label": label, title: label },
      icon(name === "center" ? ICONS.dot : ICONS.arrow),
    );
    momentary(button, (pressed) => actions.press(store.state.selected, name, pressed));
    return { name, button };
  });
  const pad = h(
    "div",
    { class: "dpad", id: "dpad", role: "group", "aria-label": t("dpad") },
    ...buttons.map(({ button }) => button),
  );
  // On phones the pad can be hidden so that it does not cover the view.
  const fold = h(
    "button",
    { type: "button", class: "fold", "aria-controls": "dpad", onclick: () => setFolded(!element.hasAttribute("data-folded")) },
    icon(CHEVRON),
  );
  const element = h("div", { class: "drive" }, pad, fold);
  /** @param {boolean} folded */
  const setFolded = (folded) => {
    trySetItem(localStore, FOLDED_KEY, String(folded));
    element.toggleAttribute("data-folded", folded);
    const label = t(folded ? "dpad.unfold" : "dpad.fold");
    setAttribute(fold, "aria-expanded", String(!folded));
    setAttribute(fold, "aria-label", label);
    setAttribute(fold, "title", label);
  };
  setFolded(localStore.getItem(FOLDED_KEY) === "true");
  return {
    slot: "stage",
    element,
    render({ connection, readOnly, robots, selected }) {
      for (const { name, button } of buttons) {
        setAttribute(button, "aria-pressed", String(robots[selected]?.buttons[name] ?? false));
        lock(button, disabledReason({ connection, readOnly }, t));
      }
    },
  };
}
