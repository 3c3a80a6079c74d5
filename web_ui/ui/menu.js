// A button that opens a list: actions, or one of several choices. Arrow keys, Home and End move in the list; Escape and a
// choice close it and return the focus to the button.

import { h, setAttribute } from "./dom.js";
import { icon } from "./icons.js";
import { watchListKeys } from "./list_keys.js";
import { makeSheet } from "./sheet.js";

/**
 * @typedef {object} Entry
 * @property {string} label
 * @property {() => void} act
 * @property {import("./icons.js").IconName} [icon]
 * @property {boolean} [chosen]   of a choice: whether it is the current one
 * @property {Record<string, string>} [attributes]   such as `data-robot`, or `style` with `--color`
 * @property {boolean} [swatch]   whether a dot in `--color` stands before the label
 */

/**
 * @param {object} options
 * @param {string} options.id       of the list
 * @param {HTMLButtonElement} options.button
 * @param {string} options.label    name of the list
 * @param {boolean} [options.isChoice]   one of the entries is chosen
 * @param {() => readonly Entry[]} options.entries   asked each time when it opens
 * @returns {{ element: HTMLElement, list: HTMLElement, refresh: () => void }}   element: button and list; refresh: call
 *   when entries have changed while it may be open
 */
export function menu({ id, button, label, isChoice = false, entries }) {
  const [role, entryRole] = isChoice ? ["listbox", "option"] : ["menu", "menuitem"];
  const list = h("div", { id, role, "aria-label": label });
  setAttribute(button, "aria-haspopup", role);
  const rows = () => /** @type {HTMLElement[]} */ ([...list.children]);

  const fill = () => {
    const at = rows().indexOf(/** @type {HTMLElement} */ (document.activeElement));
    list.replaceChildren(
      ...entries().map(({ label: text, act, icon: name, chosen, attributes = {}, swatch = false }) =>
        h(
          "button",
          {
            type: "button",
            class: "btn",
            role: entryRole,
            tabindex: "-1",
            ...(isChoice ? { "aria-selected": String(chosen ?? false) } : {}),
            ...attributes,
            onclick: () => {
              list.hidePopover();
              act();
            },
          },
          ...(swatch ? [h("span", { class: "swatch", "aria-hidden": "true" })] : []),
          ...(name === undefined ? [] : [icon(name)]),
          h("span", { class: "grow" }, text),
          ...(isChoice ? [icon("check", { small: true })] : []),
        ),
      ),
    );
    if (at >= 0) rows()[Math.min(at, rows().length - 1)]?.focus();
  };

  makeSheet(button, list, {
    opened: () => (rows().find((row) => row.ariaSelected === "true") ?? rows()[0])?.focus(),
  });
  list.addEventListener("beforetoggle", (event) => {
    if (/** @type {ToggleEvent} */ (event).newState === "open") fill();
  });
  watchListKeys(list, rows);
  return {
    element: h("span", { class: "menu" }, button, list),
    list,
    refresh: () => {
      if (list.matches(":popover-open")) fill();
    },
  };
}
