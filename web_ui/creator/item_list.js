// The list of all items of the playground; a click selects one.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @param {import("../playground/labels.js").Labels} labels @param {import("./creator_model.js").CreatorModel} model */
export function itemList(labels, model) {
  const { t } = labels;
  const count = h("span", { class: "small muted" });
  const caret = h("span", { class: "turns" }, icon("caretDown", { small: true }));
  const summary = h("summary", {}, icon("list", { small: true }), h("span", { class: "grow" }, t("items")), count, caret);
  const list = h("ul", { class: "items" });
  const element = h("details", { class: "item-list disc" }, summary, list);
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
            { type: "button", class: "btn item", "data-item": name, onclick: () => model.select(name) },
            h("span", { class: "grow" }, labels.kind(kind)),
            h("small", { class: "muted" }, name),
          ),
        }));
        list.replaceChildren(...rows.map(({ button }) => h("li", {}, button)));
        setText(count, items.length === 1 ? t("items.one") : t("items.count", { count: items.length }));
      }
      for (const { name, button } of rows) setAttribute(button, "aria-pressed", String(name === model.selected));
    },
  };
}
