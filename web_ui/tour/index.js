// The tour of the page: a card that does not block the page.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { translator } from "../i18n/index.js";
import tourTexts from "../i18n/tour.texts.js";
import { placed } from "./place.js";
import { STEPS } from "./steps.js";

import "./tour.css";

/** Distance of the ring from the highlighted element; it stays inside the window. */
const RING_PX = 5;

/**
 * @param {object} options
 * @param {string} options.language
 * @param {number} options.step     the first step to show
 * @param {(step: number) => void} options.stepped
 * @param {() => void} options.close
 */
export function createTour({ language, step: first, stepped, close }) {
  const t = translator(language, tourTexts);
  let step = first;
  const title = h("h2", { id: "tour-title" });
  const text = h("p", { id: "tour-text" });
  const again = h("small", {}, t("again"));
  const count = h("span", { class: "tour-count" });
  const back = h("button", { type: "button", class: "btn", onclick: () => go(-1) }, t("back"));
  const next = h("button", { type: "button", class: "btn you next", onclick: () => go(1) });
  const card = h(
    "dialog",
    { class: "tour", "aria-labelledby": "tour-title", "aria-describedby": "tour-text" },
    h(
      "div",
      { class: "tour-head" },
      title,
      h(
        "button",
        { type: "button", class: "btn icon tour-close", "aria-label": t("close"), title: t("close"), onclick: close },
        icon("close"),
      ),
    ),
    h("div", { "aria-live": "polite" }, text, again),
    h("div", { class: "tour-foot" }, count, back, next),
  );
  const ring = h("div", { class: "tour-ring", "aria-hidden": "true" });
  card.addEventListener("keydown", (event) => {
    event.stopPropagation(); // Escape closes the tour and does not stop robots
    if (event.key === "Escape") close();
  });

  /** The element that the step shows; null if none is visible. */
  const target = () => {
    for (const selector of STEPS[step].targets) {
      const found = document.querySelector(selector);
      if (found !== null && found.getClientRects().length > 0) return found;
    }
    return null;
  };

  /** @param {number} by */
  const go = (by) => {
    if (step + by >= STEPS.length) return close();
    step = Math.max(0, step + by);
    stepped(step);
    show();
    if (step === 0) next.focus(); // the button that had the focus is now disabled
  };

  const show = () => {
    const { name } = STEPS[step];
    const isLast = step === STEPS.length - 1;
    setText(title, t(name));
    setText(text, t(`${name}.text`));
    again.hidden = !isLast;
    setText(count, t("count", { step: step + 1, steps: STEPS.length }));
    setText(next, t(isLast ? "done" : "next"));
    back.disabled = step === 0;
    target()?.scrollIntoView({ block: "nearest" });
    render();
  };

  const render = () => {
    const box = target()?.getBoundingClientRect() ?? null;
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

  return {
    render,
    /** Call after the card has been added to the page. */
    start() {
      document.body.append(ring, card);
      card.show();
      show();
      next.focus({ preventScroll: true });
      window.addEventListener("resize", render);
      window.addEventListener("scroll", render, { capture: true, passive: true });
    },
    destroy() {
      window.removeEventListener("resize", render);
      window.removeEventListener("scroll", render, { capture: true });
      card.remove();
      ring.remove();
    },
  };
}

/** @typedef {ReturnType<typeof createTour>} Tour */

/** @param {HTMLElement} element @param {Record<string, number>} box  CSS pixels */
function place(element, box) {
  const style = Object.entries(box).map(([name, value]) => `${name}: ${Math.round(value)}px`);
  setAttribute(element, "style", style.join("; "));
}
