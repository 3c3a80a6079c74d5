// The choice between the looks of blocks, in the menu of the file.

import { h } from "../../ui/dom.js";

/** @typedef {import("../toolbox.js").Look} Look */

/**
 * @param {object} options
 * @param {import("../../i18n/index.js").Translate} options.t  of blockly.json
 * @param {(look: Look) => void} options.choose
 */
export function lookChoice({ t, choose }) {
  const group = h("div", { class: "seg", role: "group", "aria-labelledby": "blocks-look" });
  const name = h("span", { class: "small muted", id: "blocks-look" }, t("view.look"));
  const element = h("div", { class: "blocks-looks" }, name, group);
  return {
    element,
    /** @param {readonly Look[]} looks  that can be chosen @param {Look | null} shown */
    render(looks, shown) {
      element.hidden = looks.length < 2;
      /** @param {Look} look */
      const button = (look) => {
        const isShown = look === shown;
        const attributes = { type: "button", class: "btn note", "data-look": look, "aria-pressed": String(isShown) };
        return h("button", { ...attributes, onclick: () => isShown || choose(look) }, t(`look.${look}`));
      };
      group.replaceChildren(...looks.map(button));
    },
  };
}
