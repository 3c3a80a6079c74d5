// A sheet of which there is one for many buttons: it opens beside the one that was used.

import { placeBeside } from "../../ui/sheet.js";

/** @param {HTMLElement} sheet  a popover @param {Element} button */
export function openBeside(sheet, button) {
  sheet.showPopover();
  move(sheet, button);
}

/** Place an open sheet again: its size has changed. @param {HTMLElement} sheet @param {Element} button */
export function move(sheet, button) {
  const { offsetWidth: width, offsetHeight: height } = sheet;
  const { innerWidth, innerHeight } = window;
  const { left, top } = placeBeside({ width, height }, button.getBoundingClientRect(), {
    width: innerWidth,
    height: innerHeight,
  });
  sheet.style.left = `${Math.round(left)}px`;
  sheet.style.top = `${Math.round(top)}px`;
}
