// Notices about user actions: one area over the view, or inside an open dialog.
// Success messages disappear by themselves; errors stay until they are closed or their cause is resolved. The newest is
// shown; those before it follow when it is gone.

import { h } from "../ui/dom.js";
import { keepFocus } from "../ui/focus.js";
import { icon } from "../ui/icons.js";

/** How long success messages are shown. */
export const SUCCESS_MS = 6000;

/** Where notices are shown: in a modal dialog, which covers the page; else over the view, or where a phone has none. */
function placeOfNotices() {
  const dialog = document.querySelector("dialog:modal");
  if (dialog !== null) return dialog;
  const view = document.querySelector("#messages");
  return view?.checkVisibility() === false ? document.querySelector("#work") : view;
}

/**
 * Over the view, notices come before what the robots say; in the work area, before the open tab.
 *
 * @param {Element} place @param {HTMLElement} element
 */
function put(place, element) {
  const tabs = place.querySelector(":scope > #tabs");
  if (tabs !== null) return tabs.after(element);
  const fallen = place.querySelector(":scope > .fallen");
  if (fallen === null) place.append(element);
  else fallen.before(element);
}

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function noticesPanel({ text, store }) {
  const pageText = text("page");
  const element = h("div", { class: "notices", role: "alert" });
  /** @type {import("../state/index.js").Notice[] | null} */ let shown = null;
  /** What the simulator said, in English. @param {string} line */
  const technicalLine = (line) =>
    h("details", { class: "small muted" }, h("summary", {}, pageText("details")), h("p", { lang: "en" }, line));
  /** @type {Map<number, ReturnType<typeof setTimeout>>} */ const ends = new Map();

  /** @param {number} id */
  const dismiss = (id) => store.dispatch({ type: "dismiss", id });
  /** Dismiss a notice, but not while pointer or focus is on the notices. @param {number} id */
  const end = (id) => {
    if (element.matches(":hover, :focus-within")) ends.set(id, setTimeout(end, SUCCESS_MS, id));
    else dismiss(id);
  };
  /** @param {import("../state/index.js").Notice[]} notices */
  const time = (notices) => {
    for (const [id, timer] of ends) {
      if (notices.some((notice) => notice.id === id)) continue;
      clearTimeout(timer);
      ends.delete(id);
    }
    for (const { id, level } of notices) {
      if (level === "info" && !ends.has(id)) ends.set(id, setTimeout(end, SUCCESS_MS, id));
    }
  };

  return {
    slot: "messages",
    element,
    render({ notices }) {
      const place = placeOfNotices();
      if (place !== null && element.parentElement !== place) put(place, element);
      if (notices === shown) return;
      shown = notices;
      time(notices);
      const messages = notices.map(({ id, level, text: words, technical }) =>
        h(
          "div",
          { class: `notice message ${level}` },
          ...(level === "info" ? [] : [icon("warning")]),
          h(
            "div",
            { class: "grow" },
            h("p", {}, words || pageText("notice.simulator")),
            ...(technical === "" ? [] : [technicalLine(technical)]),
          ),
          h(
            "button",
            { type: "button", class: "btn icon", "aria-label": pageText("notice.dismiss"), onclick: () => dismiss(id) },
            icon("close"),
          ),
        ),
      );
      keepFocus(
        element,
        () => element.replaceChildren(...messages),
        () => element.querySelector("button"),
      );
    },
  };
}
