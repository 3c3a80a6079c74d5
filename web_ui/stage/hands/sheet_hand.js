// A hand with values: its button opens a small sheet.

import { h, lock, setAttribute } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { makeSheet } from "../../ui/sheet.js";
import { HAND_KEYS } from "../../input/hand_keys.js";

/**
 * @param {object} options
 * @param {import("../../input/hand_keys.js").HandName} options.name
 * @param {import("../../ui/icons.js").IconName} options.drawing
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {readonly Node[]} options.content
 * @param {() => boolean} [options.isHeld]   whether the hand does something to the robot now
 * @param {() => void} [options.refresh]   shows the settings of the chosen robot
 * @returns {import("./index.js").Hand}
 */
export function sheetHand({ name, drawing, t, content, isHeld, refresh }) {
  const label = t(`hand.${name}`);
  const controls = h("fieldset", { "aria-label": label }, ...content);
  const sheet = h(
    "div",
    { id: `${name}-sheet`, class: "hand-sheet", role: "group", "aria-label": label },
    h("h3", {}, label),
    controls,
  );
  const title = t("hand.withKey", { name: label, key: HAND_KEYS[name] });
  const button = h(
    "button",
    { type: "button", class: "hand", "data-hand": name, title },
    icon(drawing),
    h("span", {}, label),
  );
  makeSheet(button, sheet);
  /** @type {string | null} */ let shown = null;
  return {
    element: h("span", { class: "menu" }, button, sheet),
    render({ selected }, reason) {
      lock(button, reason);
      lock(controls, reason);
      if (selected !== shown) refresh?.();
      shown = selected;
      if (isHeld !== undefined) setAttribute(button, "data-held", String(isHeld()));
    },
  };
}
