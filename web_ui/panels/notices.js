// What went wrong, one card each; errors are read out at once.

import { h, icon, ICONS } from "./dom.js";

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function noticesPanel({ t, store }) {
  const element = h("div", { class: "notices", role: "alert" });
  /** @type {import("../state/index.js").Notice[] | null} */ let shown = null;
  return {
    slot: "main",
    element,
    render({ notices }) {
      if (notices === shown) return;
      shown = notices;
      element.replaceChildren(
        ...notices.map(({ id, level, text }) =>
          h(
            "div",
            { class: `notice ${level}` },
            h("p", {}, text),
            h(
              "button",
              {
                type: "button",
                class: "plain",
                "aria-label": t("notice.dismiss"),
                onclick: () => store.dispatch({ type: "dismiss", id }),
              },
              icon(ICONS.close),
            ),
          ),
        ),
      );
    },
  };
}
