// Helpers to create and update elements. Panels write to the DOM only where a value changed.

import { onShiftRelease } from "../input/sticky_press.js";

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

/** An icon from a single path on a 24×24 grid; the surrounding button has the label. @param {string} path */
export function icon(path) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("viewBox", "0 0 24 24");
  svg.setAttribute("aria-hidden", "true");
  svg.setAttribute("class", "icon");
  const shape = document.createElementNS("http://www.w3.org/2000/svg", "path");
  shape.setAttribute("d", path);
  svg.append(shape);
  return svg;
}

export const ICONS = {
  play: "M7 4.500v15l12-7.500z",
  pause: "M6 4.500h4.200v15H6zM13.800 4.500H18v15h-4.200z",
  step: "M5 4.500v15l9-7.500zM16 4.500h3.200v15H16z",
  stop: "M6 6h12v12H6z",
  restart: "M12 5V1.500L6.500 6 12 10.500V7.200a5.300 5.300 0 1 1-5.300 5.300H4.500A7.500 7.500 0 1 0 12 5z",
  open: "M3 5h6l2 2.500h10V10H6.800L4.500 18.500 3 18zM7.800 11.500H22L19.700 19H5.500z",
  close:
    "M6.200 4.800 12 10.600l5.800-5.800 1.400 1.400L13.400 12l5.800 5.800-1.400 1.400L12 13.400l-5.800 5.800-1.400-1.400L10.600 12 4.800 6.200z",
  arrow: "M12 5.500 19.500 17h-15z",
  dot: "M12 6a6 6 0 1 0 0 12 6 6 0 0 0 0-12z",
  home: "M12 3 2.500 11H5v9h5.200v-5.500h3.600V20H19v-9h2.500z",
  top: "M4 4h16v16H4zM6.200 6.200v11.600h11.600V6.200zM10 10h4v4h-4z",
  follow:
    "M12 2.500a9.500 9.500 0 1 0 0 19 9.500 9.500 0 0 0 0-19zm0 2.200a7.300 7.300 0 1 1 0 14.600 7.300 7.300 0 0 1 0-14.600zM12 8a4 4 0 1 0 0 8 4 4 0 0 0 0-8z",
  move: "M12 1.500 16 6h-2.700v4.700H18V8l4.500 4-4.500 4v-2.700h-4.700V18H16l-4 4.500L8 18h2.700v-4.700H6V16l-4.500-4L6 8v2.700h4.700V6H8z",
  eye: "M12 5C6.500 5 2.600 9.200 1.500 12c1.100 2.800 5 7 10.500 7s9.400-4.200 10.500-7C21.400 9.200 17.500 5 12 5zm0 2.200a4.800 4.800 0 1 1 0 9.600 4.800 4.800 0 0 1 0-9.600zM12 9.500a2.500 2.500 0 1 0 0 5 2.500 2.500 0 0 0 0-5z",
  camera: "M8.500 4 7 6.500H2.500v13h19v-13H17L15.500 4zM12 8.500a4.500 4.500 0 1 1 0 9 4.500 4.500 0 0 1 0-9zm0 2.200a2.300 2.300 0 1 0 0 4.600 2.300 2.300 0 0 0 0-4.600z",
  loud: "M3 9v6h4l5.500 4.500v-15L7 9zM15 8.200v7.600a4.300 4.300 0 0 0 0-7.600zM15 4v2.200a6.300 6.300 0 0 1 0 11.600V20a8.400 8.400 0 0 0 0-16z",
  mute: "M3 9v6h4l5.500 4.500v-15L7 9zM15 9.400l1.400-1.400 2.100 2.100L20.600 8 22 9.400l-2.100 2.100 2.100 2.100-1.400 1.400-2.100-2.100-2.100 2.100-1.400-1.400 2.100-2.100z",
  beams: "M3 10.500h4v3H3zM9 11l12-6v2.500l-9.500 4zM9 13l12 6v-2.500l-9.500-4zM11 11.200h10v1.600H11z",
};

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
 * @param {{ id: string, label: string, help: string, accept: string, open: (file: File) => void }} options
 */
export function fileButton({ id, label, help, accept, open }) {
  const input = h("input", { id, type: "file", accept, hidden: true, "aria-label": help });
  input.addEventListener("change", () => {
    const file = input.files?.[0];
    if (file !== undefined) open(file);
    input.value = ""; // so that the same file can be opened again
  });
  const button = h("button", { type: "button", title: help, onclick: () => input.click() }, icon(ICONS.open), label);
  return h("span", { class: "file" }, button, input);
}
