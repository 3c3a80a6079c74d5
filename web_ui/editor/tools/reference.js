// The reference of native functions, local events and variables; a click inserts the name.

import { h, setText } from "../../ui/dom.js";
import { signature } from "../help.js";

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function referenceTool({ t, insert }) {
  const filter = h("input", { type: "search", placeholder: t("filter"), "aria-label": t("filter") });
  const list = h("div", { class: "scroll" });
  const nothing = h("p", { class: "nothing" }, t("reference.none"));
  /** @type {import("../state.js").Target | null} */ let shown = null;

  /** @param {string} shownName @param {string} text @param {string} help */
  const entry = (shownName, text, help) =>
    h(
      "div",
      { class: "entry-help", "data-search": `${shownName} ${help}`.toLowerCase() },
      h(
        "button",
        { type: "button", class: "plain", title: t("reference.insert"), onclick: () => insert(text) },
        shownName,
      ),
      h("p", {}, help),
    );
  const apply = () => {
    const wanted = filter.value.trim().toLowerCase();
    for (const item of list.querySelectorAll("[data-search]")) {
      /** @type {HTMLElement} */ (item).hidden = !(item.getAttribute("data-search") ?? "").includes(wanted);
    }
  };
  filter.addEventListener("input", apply);
  return {
    name: "reference",
    element: h("div", { class: "reference" }, h("div", { class: "row" }, filter), nothing, list),
    render({ target }) {
      if (target === shown) return;
      shown = target;
      nothing.hidden = target !== null;
      setText(list, "");
      if (target === null) return;
      list.append(
        h("h2", {}, t("reference.natives")),
        ...target.natives
          .filter((native) => !native.hidden)
          .map((native) => entry(signature(native), `call ${signature(native)}`, native.help)),
        h("h2", {}, t("reference.events")),
        ...target.events.map(({ name, help }) => entry(name, `onevent ${name}`, help)),
        h("h2", {}, t("tool.variables")),
        ...target.variables
          .filter((variable) => !variable.hidden)
          .map(({ name, size, help }) => entry(size === 1 ? name : `${name}[${size}]`, name, help)),
      );
      apply();
    },
  };
}
