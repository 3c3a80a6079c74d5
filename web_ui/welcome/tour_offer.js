// The card below "?" that offers the tour.

import { h } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";

const MARGIN_PX = 8;
/** From the tip of the card to its right edge, where there is room. */
const TIP_PX = 60;
const BELOW_PX = 18;

/**
 * @param {import("../shell/context.js").Context} context
 * @param {import("../i18n/index.js").Translate} t
 */
export function tourOffer({ tour, scene }, t) {
  const decline = () => {
    tour.decline();
    scene.invalidate();
  };
  const element = h(
    "aside",
    { class: "welcome-tour", role: "dialog", "aria-labelledby": "welcome-tour-title" },
    h("h3", { id: "welcome-tour-title" }, t("tour.new")),
    h("p", { class: "muted small" }, t("tour.text")),
    h(
      "div",
      { class: "welcome-row" },
      h("button", { type: "button", class: "btn soft", "data-tour": "yes", onclick: () => void tour.open() }, t("tour.yes")),
      h("button", { type: "button", class: "btn", "data-tour": "no", onclick: decline }, t("tour.no")),
    ),
  );
  element.addEventListener("keydown", (event) => {
    if (event.key !== "Escape") return;
    event.stopPropagation();
    decline();
  });
  /** Under the button in the header, wherever the width of the window puts it. */
  const place = () => {
    const button = document.querySelector("#help-open")?.getBoundingClientRect();
    if (button === undefined) return;
    const { innerWidth } = window;
    const middle = (button.left + button.right) / 2;
    const most = innerWidth - element.offsetWidth - MARGIN_PX;
    const right = Math.max(MARGIN_PX, Math.min(innerWidth - middle - TIP_PX, most));
    element.style.right = `${Math.round(right)}px`;
    element.style.top = `${Math.round(button.bottom + BELOW_PX)}px`;
    element.style.setProperty("--tip", `${Math.round(innerWidth - right - middle)}px`);
  };
  document.body.append(element);
  place();
  window.addEventListener("resize", place);
  return {
    destroy() {
      window.removeEventListener("resize", place);
      keepFocus(
        element,
        () => element.remove(),
        () => document.querySelector("#help-open"),
      );
    },
  };
}
