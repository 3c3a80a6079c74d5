// The menu of a row: copy it, insert one, move it. There is one menu; it opens beside the number of the row.

import { h, lock } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { watchListKeys } from "../../ui/list_keys.js";
import { openBeside } from "./open_beside.js";

/** @typedef {"copy" | "insert" | "up" | "down"} RowVerb */
/** @type {Record<RowVerb, { sign: import("../../ui/icons.js").IconName, key: string }>} */
const VERBS = {
  copy: { sign: "copy", key: "Ctrl+D" },
  insert: { sign: "add", key: "" },
  up: { sign: "caretUp", key: "Ctrl+↑" },
  down: { sign: "caretDown", key: "Ctrl+↓" },
};

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t
 * @param {(verb: RowVerb, row: number) => void} options.act
 */
export function rowMenu({ t, act }) {
  let row = 0;
  const names = /** @type {RowVerb[]} */ (Object.keys(VERBS));
  const entries = names.map((verb) =>
    h(
      "button",
      {
        type: "button",
        class: "btn",
        role: "menuitem",
        tabindex: "-1",
        "data-row-verb": verb,
        onclick: () => (element.hidePopover(), act(verb, row)),
      },
      icon(VERBS[verb].sign, { small: true }),
      h("span", { class: "grow" }, t(`row.${verb}`)),
      ...(VERBS[verb].key === "" ? [] : [h("kbd", { class: "kbd" }, VERBS[verb].key)]),
    ),
  );
  const element = h(
    "div",
    { id: "vpl-row-menu", class: "sheet vpl-row-menu", popover: "auto", role: "menu", "aria-label": t("row", { row: 1 }) },
    ...entries,
  );
  watchListKeys(element, () => entries.filter(({ disabled }) => !disabled));
  return {
    element,
    /** @param {number} index @param {number} last  index of the last row, which is empty @param {Element} button */
    open(index, last, button) {
      row = index;
      element.setAttribute("aria-label", t("row", { row: index + 1 }));
      /** @param {RowVerb} verb @param {boolean} isPossible */
      const allow = (verb, isPossible) => lock(entries[names.indexOf(verb)], isPossible ? "" : t("row", { row: index + 1 }));
      allow("copy", index < last);
      allow("up", index > 0);
      allow("down", index < last);
      openBeside(element, button);
      entries.find(({ disabled }) => !disabled)?.focus();
    },
  };
}
