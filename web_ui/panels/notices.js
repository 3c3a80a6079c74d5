// Notices about user actions: one area over the view, or inside an open dialog, which covers everything else.
// Success messages disappear by themselves; errors stay until they are closed or their cause is resolved.

import { h, icon, ICONS } from "./dom.js";

/** How long success messages are shown. */
export const SUCCESS_MS = 6000;

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function noticesPanel({ t, store }) {
  const element = h("div", { class: "notices", role: "alert" });
  /** @type {import("../state/index.js").Notice[] | null} */ let shown = null;
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
    slot: "main",
    element,
    render({ notices }) {
      // A modal dialog covers the page, so notices must be inside it to be seen and clicked.
      const place = document.querySelector("dialog:modal") ?? document.querySelector('[data-slot="main"]');
      if (place !== null && element.parentElement !== place) place.append(element);
      if (notices === shown) return;
      shown = notices;
      time(notices);
      element.replaceChildren(
        ...notices.map(({ id, level, text }) =>
          h(
            "div",
            { class: `notice ${level}` },
            h("p", {}, text),
            h(
              "button",
              { type: "button", class: "plain", "aria-label": t("notice.dismiss"), onclick: () => dismiss(id) },
              icon(ICONS.close),
            ),
          ),
        ),
      );
    },
  };
}
