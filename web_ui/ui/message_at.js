// One message at the place in the window that it is about, above everything. It stays until it is closed or replaced.

import { h } from "./dom.js";
import { icon } from "./icons.js";
import { placeBeside } from "./sheet.js";

export class MessageAt {
  /** @param {HTMLElement} parent */
  constructor(parent) {
    this.element = h("div", { class: "message-at", role: "alert" });
    this.element.popover = "manual";
    parent.append(this.element);
    document.addEventListener(
      "keydown",
      (event) => {
        const isOnTop = [...document.querySelectorAll(":popover-open")].at(-1) === this.element;
        if (event.key !== "Escape" || !isOnTop || document.querySelector("dialog:modal") !== null) return;
        event.stopPropagation(); // Escape closes what is open before it stops robots
        this.hide();
      },
      { capture: true },
    );
  }

  /**
   * @param {{ x: number, y: number }} place   CSS pixels of the window
   * @param {readonly Node[]} children
   * @param {string} close   name of the button that closes it
   */
  show({ x, y }, children, close) {
    const { element } = this;
    element.replaceChildren(
      h("div", { class: "grow" }, ...children),
      h("button", { type: "button", class: "btn icon", title: close, "aria-label": close, onclick: () => this.hide() }, icon("close")),
    );
    element.showPopover();
    const { offsetWidth: width, offsetHeight: height } = element;
    const spot = { left: x, right: x, top: y, bottom: y };
    const { left, top } = placeBeside({ width, height }, spot, { width: innerWidth, height: innerHeight });
    element.style.left = `${Math.round(left)}px`;
    element.style.top = `${Math.round(top)}px`;
  }

  hide() {
    if (this.element.matches(":popover-open")) this.element.hidePopover();
  }
}
