// A list of controls that lies open, or in a sheet that a button opens where there is no room.

import { makeSheet } from "./sheet.js";

/**
 * @param {HTMLButtonElement} button   only shown while the list is folded
 * @param {HTMLElement} list           needs an id; stands after the button
 * @returns {(isFolded: boolean) => void}
 */
export function foldedList(button, list) {
  makeSheet(button, list);
  let folded = true;
  return (now) => {
    if (now === folded) return;
    folded = now;
    button.hidden = !now;
    list.popover = now ? "auto" : null;
    list.classList.toggle("sheet", now);
  };
}
