// Stars: those that were reached are full. A word says how many, for screen readers.

import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/**
 * @param {readonly boolean[]} reached
 * @param {import("../i18n/index.js").Translate} t
 */
export function starRow(reached, t) {
  const count = reached.filter((has) => has).length;
  return h(
    "span",
    { class: "mission-stars", role: "img", "aria-label": t("stars", { count, all: reached.length }) },
    ...reached.map((has) => h("span", { class: has ? "mission-star" : "mission-star mission-no" }, icon(has ? "star" : "starEmpty"))),
  );
}

/** As many of all. @param {number} count @param {number} all */
export function firstOf(count, all) {
  return Array.from({ length: all }, (_, at) => at < count);
}
