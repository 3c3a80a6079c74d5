// A pin: what is pinned is listed first, and plotted.

import { h, setAttribute } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";

/** @param {string} label @param {() => void} act */
export function pinButton(label, act) {
  const attributes = { type: "button", class: "pin", "aria-label": label, title: label, onclick: act };
  return h("button", attributes, icon("pin", { small: true }));
}

/** @param {Element} pin @param {boolean} isPinned */
export function showPin(pin, isPinned) {
  setAttribute(pin, "aria-pressed", String(isPinned));
}
