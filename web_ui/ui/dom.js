// Helpers to create and update elements. Panels write to the DOM only where a value changed.

import { icon } from "./icons.js";
import { onShiftRelease } from "./sticky_press.js";

/**
 * @template {keyof HTMLElementTagNameMap} Tag
 * @param {Tag} tag
 * @param {Record<string, any>} attributes  such as `class`, `onclick`, `aria-…`; null or false: left out
 * @param {...(Node | string)} children
 * @returns {HTMLElementTagNameMap[Tag]}
 */
export function h(tag, attributes = {}, ...children) {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === false) continue;
    if (typeof value === "function") element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  element.append(...children);
  return element;
}

/** @param {Element} element @param {string} text */
export function setText(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/** @param {Element} element @param {string} name @param {string} value */
export function setAttribute(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

/** @type {WeakMap<Element, string>} tooltips of controls while they are enabled */
const tooltips = new WeakMap();

/**
 * Enable a control, or disable it and show the reason as tooltip.
 *
 * @param {HTMLButtonElement | HTMLSelectElement | HTMLInputElement | HTMLFieldSetElement} control
 * @param {string} reason  empty: enabled
 */
export function lock(control, reason) {
  const own = tooltips.get(control) ?? control.title;
  tooltips.set(control, own);
  if (control.disabled !== (reason !== "")) control.disabled = reason !== "";
  if (control.title !== (reason || own)) control.title = reason || own;
}

/**
 * A momentary control: pressed by pointer, Enter or Space, and released when that ends. A click with Shift keeps it
 * pressed until Shift is released.
 *
 * @param {HTMLElement} element
 * @param {(pressed: boolean) => void} change
 */
export function momentary(element, change) {
  /** @type {Set<string | number>} */ const sources = new Set();
  /** @param {string | number} source */
  const down = (source) => {
    if (sources.size === 0) change(true);
    sources.add(source);
  };
  /** @param {string | number} source */
  const up = (source) => {
    if (sources.delete(source) && sources.size === 0) change(false);
  };
  element.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    element.setPointerCapture(event.pointerId);
    down(event.pointerId);
  });
  element.addEventListener("pointerup", ({ shiftKey }) => {
    if (!shiftKey) return;
    down("Shift");
    onShiftRelease(() => up("Shift"));
  });
  for (const name of /** @type {const} */ (["pointerup", "pointercancel", "lostpointercapture"])) {
    element.addEventListener(name, (event) => up(event.pointerId));
  }
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    if (!event.repeat) down(event.key);
  });
  element.addEventListener("keyup", (event) => up(event.key));
  element.addEventListener("blur", () => ["Enter", " "].forEach(up));
  element.addEventListener("contextmenu", (event) => event.preventDefault());
}

const FOCUSABLE = "input, select, summary, button:enabled";

/**
 * Replace the children of an element; the keyboard focus stays at the same position.
 *
 * @param {HTMLElement} parent
 * @param {readonly Node[]} children
 */
export function renew(parent, children) {
  const focusable = () => /** @type {HTMLElement[]} */ ([...parent.querySelectorAll(FOCUSABLE)]);
  const at = focusable().findIndex((target) => target === document.activeElement);
  parent.replaceChildren(...children);
  if (at < 0) return;
  const target = focusable()[Math.min(at, focusable().length - 1)];
  target?.focus();
  if (target instanceof HTMLInputElement) target.select(); // as after Tab
}

/** The button of a `fileButton`. @param {HTMLElement} file */
export function buttonOf(file) {
  return /** @type {HTMLButtonElement} */ (file.querySelector("button"));
}

/**
 * A button that opens a file dialog; the native file input is hidden behind it.
 *
 * @param {{ id: string, label: string, help: string, accept: string, open: (file: File) => void, look?: string }} options
 *   look: classes of the button
 */
export function fileButton({ id, label, help, accept, open, look = "btn line" }) {
  const input = h("input", { id, type: "file", accept, hidden: true, "aria-label": help });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file !== undefined) open(file);
    input.value = ""; // so that the same file can be opened again
  });
  const attributes = { type: "button", class: look, title: help, onclick: () => input.click() };
  const button = h("button", attributes, icon("open"), ...(label === "" ? [] : [h("span", {}, label)]));
  return h("span", { class: "file" }, button, input);
}
