// The card that offers the tour: below "?", and never over a control or a message. Where there is little room it is one
// row; where there is none, it waits.

import { h } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";

const MARGIN_PX = 8;
/** What it must not cover. */
const CONTROLS = "#messages > *, #trouble, .welcome-start, .welcome-watch, .views .btn, #tray .btn, #tray .hand";
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
  /** Under the button in the header; where the buttons over the view are shown, below those, if the view has room for it. */
  const place = () => {
    const button = document.querySelector("#help-open")?.getBoundingClientRect();
    const stage = document.querySelector("#scene")?.getBoundingClientRect();
    if (button === undefined || stage === undefined) return;
    const { innerWidth } = window;
    const views = document.querySelector(".view-row")?.getBoundingClientRect();
    const isBelowViews = views !== undefined && views.height > 0;
    const middle = (button.left + button.right) / 2;
    /** @param {boolean} isCompact */
    const put = (isCompact) => {
      element.toggleAttribute("data-compact", isCompact);
      const most = innerWidth - element.offsetWidth - MARGIN_PX;
      const wanted = isBelowViews ? innerWidth - views.right : innerWidth - middle - TIP_PX;
      const right = Math.max(MARGIN_PX, Math.min(wanted, most));
      const top = isBelowViews ? views.bottom + MARGIN_PX : button.bottom + BELOW_PX;
      element.toggleAttribute("data-below-views", isBelowViews);
      element.style.right = `${Math.round(right)}px`;
      element.style.top = `${Math.round(top)}px`;
      element.style.setProperty("--tip", `${Math.round(innerWidth - right - middle)}px`);
      const box = { left: innerWidth - right - element.offsetWidth, right: innerWidth - right, top, bottom: top + element.offsetHeight };
      return box.bottom <= stage.bottom && !coversControl(box);
    };
    const hasRoom = put(false) || put(true);
    element.style.visibility = hasRoom ? "" : "hidden";
  };
  document.body.append(element);
  place();
  const room = new ResizeObserver(place);
  for (const part of document.querySelectorAll("#scene, .view-row, #messages, .welcome-starts")) room.observe(part);
  const messages = new MutationObserver(place);
  const messagesPlace = document.querySelector("#messages");
  if (messagesPlace !== null) messages.observe(messagesPlace, { subtree: true, childList: true, attributeFilter: ["hidden"] });
  return {
    destroy() {
      room.disconnect();
      messages.disconnect();
      keepFocus(
        element,
        () => element.remove(),
        () => document.querySelector("#help-open"),
      );
    },
  };
}

/** @param {{ left: number, right: number, top: number, bottom: number }} box */
function coversControl(box) {
  return [...document.querySelectorAll(CONTROLS)].some((control) => {
    const { left, right, top, bottom, width } = control.getBoundingClientRect();
    return width > 0 && left < box.right && right > box.left && top < box.bottom && bottom > box.top;
  });
}
