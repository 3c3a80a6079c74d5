// The bar at the bottom of phones: one screen at a time.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { TAB_ICONS } from "./tabs.js";
import { TABS } from "./workspace.js";

/** @typedef {import("./workspace.js").Screen} Screen */

/**
 * Fill the bar; call again for another language.
 *
 * @param {HTMLElement} bar
 * @param {Pick<import("./context.js").Context, "text" | "workspace">} context
 * @returns {() => void}  shows the current screen; call when the workspace has changed
 */
export function fillBottomBar(bar, { text, workspace }) {
  const t = text("stage");
  const icons = { drive: /** @type {const} */ ("pad"), ...TAB_ICONS };
  const buttons = /** @type {Screen[]} */ (["drive", ...TABS]).map((screen) => ({
    screen,
    button: h(
      "button",
      {
        type: "button",
        id: `bar-${screen}`,
        onclick: () => workspace.select(screen === "drive" ? null : screen),
      },
      h("span", { class: "pill" }, icon(icons[screen])),
      h("span", { class: "name" }, t(`work.${screen}`)),
    ),
  }));
  bar.setAttribute("aria-label", t("work"));
  bar.replaceChildren(...buttons.map(({ button }) => button));
  const show = () => {
    for (const { screen, button } of buttons) {
      button.hidden = screen !== "drive" && !workspace.offered.includes(screen);
      if (screen === workspace.screen) button.setAttribute("aria-current", "page");
      else button.removeAttribute("aria-current");
    }
  };
  show();
  return show;
}
