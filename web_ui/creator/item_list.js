// The list of all items of the playground; a click selects one.

import { h, setAttribute, setText } from "../ui/dom.js";

/** @param {import("./labels.js").Labels} labels @param {import("./creator_model.js").CreatorModel} model */
export function itemList(labels, model) {
  const summary = h("summary");
  const list = h("ul", { class: "items" });
  const element = h("details", { class: "item-list" }, summary, list);
  /** @type {readonly import("../playground/parts.js").Item[] | null} */ let shown = null;
  /** @type {{ name: string, button: HTMLElement }[]} */ let rows = [];
  return {
    element,
    render() {
      const { items } = model.playground;
      if (items !== shown) {
        shown = items;
        rows = items.map(({ kind, name }) => ({
          name,
          button: h(
            "button",
            { type: "button", class: "plain", "data-item": name, onclick: () => model.select(name) },
            name,
            h("small", {}, labels.kind(kind)),
          ),
        }));
        list.replaceChildren(...rows.map(({ button }) => h("li", {}, button)));
        setText(summary, labels.t("items", { count: items.length }));
      }
      for (const { name, button } of rows) setAttribute(button, "aria-pressed", String(name === model.selected));
    },
  };
}
