// Uses a hand by its name, as a click on its button does: the tray unfolds if the hand opens a sheet.

import { unfoldTray } from "../tray.js";

/** @param {string} name */
export function useHand(name) {
  const button = /** @type {HTMLButtonElement | null} */ (document.querySelector(`#hands [data-hand="${name}"]`));
  if (button === null || button.disabled) return;
  if (button.hasAttribute("popovertarget") && !button.checkVisibility()) {
    unfoldTray();
    /** @type {HTMLElement | null} */ (button.closest("[popover]"))?.showPopover();
  }
  button.click();
}
