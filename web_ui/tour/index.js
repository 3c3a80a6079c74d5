// The tour of the page: a card that does not block the page.

import { translator } from "../i18n/index.js";
import tourTexts from "../i18n/tour.texts.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { placed } from "./place.js";
import { STEPS } from "./steps.js";

import "./tour.css";

/** Distance of the ring from the highlighted element; it stays inside the window. */
const RING_PX = 5;

/**
 * @typedef {object} TourOptions
 * @property {string} language
 * @property {number} step     the first step to show
 * @property {(step: number) => void} stepped
 * @property {() => void} close
 */

export class Tour {
  #step;

  /** @param {TourOptions} options */
  constructor({ language, step, stepped, close }) {
    const t = translator(language, tourTexts);
    this.t = t;
    this.stepped = stepped;
    this.close = close;
    this.#step = step;
    this.title = h("h2", { id: "tour-title" });
    this.text = h("p", { id: "tour-text" });
    this.again = h("small", {}, t("again"));
    this.count = h("span", { class: "tour-count" });
    this.back = h("button", { type: "button", class: "btn", onclick: () => this.#go(-1) }, t("back"));
    this.next = h("button", { type: "button", class: "btn you next", onclick: () => this.#go(1) });
    const end = h(
      "button",
      { type: "button", class: "btn icon tour-close", "aria-label": t("close"), title: t("close"), onclick: close },
      icon("close"),
    );
    this.card = h(
      "dialog",
      { class: "tour", "aria-labelledby": "tour-title", "aria-describedby": "tour-text" },
      h("div", { class: "tour-head" }, this.title, end),
      h("div", { "aria-live": "polite" }, this.text, this.again),
      h("div", { class: "tour-foot" }, this.count, this.back, this.next),
    );
    this.ring = h("div", { class: "tour-ring", "aria-hidden": "true" });
    this.card.addEventListener("keydown", (event) => {
      event.stopPropagation(); // Escape closes the tour and does not stop robots
      if (event.key === "Escape") close();
    });
  }

  /** Call after the card has been added to the page. */
  start() {
    document.body.append(this.ring, this.card);
    this.card.show();
    this.#show();
    this.next.focus({ preventScroll: true });
    window.addEventListener("resize", this.render);
    window.addEventListener("scroll", this.render, { capture: true, passive: true });
  }

  destroy() {
    window.removeEventListener("resize", this.render);
    window.removeEventListener("scroll", this.render, { capture: true });
    this.card.remove();
    this.ring.remove();
  }

  /** Place the card, and the ring around what it is about. */
  render = () => {
    const { card, ring } = this;
    const box = this.#target()?.getBoundingClientRect() ?? null;
    const window_ = { width: document.documentElement.clientWidth, height: document.documentElement.clientHeight };
    const { left, top } = placed({ width: card.offsetWidth, height: card.offsetHeight }, box, window_);
    place(card, { left, top });
    ring.hidden = box === null;
    if (box === null) return;
    const [x, y] = [Math.max(RING_PX + 1, box.left - RING_PX), Math.max(RING_PX + 1, box.top - RING_PX)];
    const right = Math.min(window_.width - RING_PX - 1, box.right + RING_PX);
    const bottom = Math.min(window_.height - RING_PX - 1, box.bottom + RING_PX);
    place(ring, { left: x, top: y, width: right - x, height: bottom - y });
  };

  /** The element that the step shows; null if none is visible. */
  #target() {
    for (const selector of STEPS[this.#step].targets) {
      const found = document.querySelector(selector);
      if (found !== null && found.getClientRects().length > 0) return found;
    }
    return null;
  }

  /** @param {number} by */
  #go(by) {
    if (this.#step + by >= STEPS.length) return this.close();
    this.#step = Math.max(0, this.#step + by);
    this.stepped(this.#step);
    this.#show();
    if (this.#step === 0) this.next.focus(); // the button that had the focus is now disabled
  }

  #show() {
    const { t } = this;
    const { name } = STEPS[this.#step];
    const isLast = this.#step === STEPS.length - 1;
    setText(this.title, t(name));
    setText(this.text, t(`${name}.text`));
    this.again.hidden = !isLast;
    setText(this.count, t("count", { step: this.#step + 1, steps: STEPS.length }));
    setText(this.next, t(isLast ? "done" : "next"));
    this.back.disabled = this.#step === 0;
    this.#target()?.scrollIntoView({ block: "nearest" });
    this.render();
  }
}

/** @param {HTMLElement} element @param {Record<string, number>} box  CSS pixels */
function place(element, box) {
  const style = Object.entries(box).map(([name, value]) => `${name}: ${Math.round(value)}px`);
  setAttribute(element, "style", style.join("; "));
}
