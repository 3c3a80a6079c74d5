// A sheet beside the button that opens it: a popover, which closes by Escape and by a click elsewhere.

import { setAttribute } from "./dom.js";

/** Distance between the sheet, its button and the edge of the window. */
const GAP_PX = 8;

/** @typedef {{ left: number, top: number, right: number, bottom: number }} Edges */
/** @typedef {{ width: number, height: number }} Size */

/**
 * The upper left corner of a sheet: below its button, else above it, always inside the window. Pure.
 *
 * @param {Size} sheet
 * @param {Edges} button
 * @param {Size} window
 */
export function placeBeside(sheet, button, window) {
  const below = button.bottom + GAP_PX;
  const above = button.top - GAP_PX - sheet.height;
  const top = below + sheet.height + GAP_PX <= window.height || above < GAP_PX ? below : above;
  const isRight = button.left + button.right > window.width;
  const left = isRight ? button.right - sheet.width : button.left;
  /** @param {number} at @param {number} size @param {number} whole */
  const inside = (at, size, whole) => Math.max(GAP_PX, Math.min(at, whole - size - GAP_PX));
  return { left: inside(left, sheet.width, window.width), top: inside(top, sheet.height, window.height) };
}

/**
 * Make an element the sheet of a button. Both must be added to the page, the sheet after the button, so that Tab leads
 * from the one into the other.
 *
 * @param {HTMLButtonElement} button
 * @param {HTMLElement} element  needs an id
 * @param {{ opened?: () => void, closed?: () => void }} [events]
 */
export function makeSheet(button, element, { opened, closed } = {}) {
  element.classList.add("sheet");
  element.popover = "auto";
  button.setAttribute("popovertarget", element.id);
  button.setAttribute("aria-expanded", "false");
  element.addEventListener("toggle", () => {
    const isOpen = element.matches(":popover-open");
    setAttribute(button, "aria-expanded", String(isOpen));
    if (isOpen) opened?.();
    else closed?.();
  });
  element.addEventListener("beforetoggle", (event) => {
    if (/** @type {ToggleEvent} */ (event).newState !== "open") return;
    requestAnimationFrame(() => {
      const { offsetWidth: width, offsetHeight: height } = element;
      const { innerWidth, innerHeight } = window;
      const { left, top } = placeBeside({ width, height }, button.getBoundingClientRect(), {
        width: innerWidth,
        height: innerHeight,
      });
      element.style.left = `${Math.round(left)}px`;
      element.style.top = `${Math.round(top)}px`;
    });
  });
}

/** Whether something is open that Escape closes: a sheet, a menu or a dialog. */
export function isSomethingOpen() {
  return document.querySelector(":popover-open, dialog:modal") !== null;
}
