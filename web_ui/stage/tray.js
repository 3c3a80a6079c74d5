// The tray below the view: the robot's buttons, and what a hand does to the robot. It folds, which the browser
// remembers.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { h, setAttribute } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { hands } from "./hands/index.js";
import { buttonPad } from "./pad.js";

/** Storage key: whether the user has folded the tray. */
const FOLDED_KEY = "trayFolded";

/** Unfold the tray, as a click on its button does. */
export function unfoldTray() {
  /** @type {HTMLElement | null} */ (document.querySelector("#tray[data-folded] #tray-unfold"))?.click();
}

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function trayPanel(context) {
  const { text, frame } = context;
  const t = text("stage");
  const pad = buttonPad(context);
  /** @type {boolean | null} null: by the room that there is */
  let folded = { true: true, false: false }[localStore.getItem(FOLDED_KEY) ?? ""] ?? null;
  /** @param {boolean} now */
  const fold = (now) => {
    folded = now;
    trySetItem(localStore, FOLDED_KEY, String(now));
    for (const sheet of element.querySelectorAll(":popover-open")) /** @type {HTMLElement} */ (sheet).hidePopover();
    show();
    if (now) open.focus();
    else pad.element.querySelector("button")?.focus();
  };
  const close = h(
    "button",
    { type: "button", class: "hand quiet", id: "tray-fold", onclick: () => fold(true) },
    icon("fold"),
    h("span", {}, t("hand.fold")),
  );
  const open = h(
    "button",
    { type: "button", class: "btn unfold", id: "tray-unfold", "aria-expanded": "false", onclick: () => fold(false) },
    icon("pad", { small: true }),
    h("span", {}, t("hand.unfold")),
    icon("caretUp", { small: true }),
  );
  const hand = hands(context, close);
  const element = h("div", { class: "tray-parts" }, pad.element, h("span", { class: "vline" }), hand.element, open);
  const show = () => {
    const tray = element.parentElement;
    const isTight = frame.isLow || (frame.layout === "single" && document.body.dataset.work === "open");
    const now = folded ?? isTight;
    tray?.toggleAttribute("data-folded", now);
    setAttribute(open, "aria-expanded", String(!now));
  };
  return {
    slot: "tray",
    element,
    render(state) {
      element.hidden = state.robots[state.selected]?.isReal ?? false; // a real robot is pressed and tapped by hand
      show();
      pad.render(state);
      hand.render(state);
    },
  };
}
