// Live values: the watched ones, those of the program, those of the robot, and the constants of the file. A click edits
// a value, a pin watches and plots it.

import { download } from "../../browser/download.js";
import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { csv } from "../numbers.js";
import { constantsPart } from "./constants.js";
import { pinButton, showPin } from "./pin.js";
import { editValue } from "./value_field.js";
import { listValues, namesIn } from "./value_names.js";

/** @typedef {import("./index.js").ToolContext} ToolContext */
/** @typedef {import("./index.js").Tool} Tool */
/** @typedef {import("./index.js").View} View */
/** @typedef {{ pin: HTMLElement, value: HTMLElement, row: HTMLElement }} Row */

/** The lists, from above. */
const LISTS = /** @type {const} */ (["watched", "own", "robot"]);

/** @implements {Tool} */
class ValuesTool {
  name = "values";
  /** @type {Map<string, Row>} */ #rows = new Map();
  /** @type {View | null} */ #shown = null;
  /** The lists as JSON, as they were drawn last. */
  #listed = "";
  #code = "";
  #used = namesIn("");

  /** @param {ToolContext} context */
  constructor(context) {
    const { t, session, define, redraw } = context;
    this.context = context;
    const word = t("filter");
    const filtering = { type: "search", class: "input", placeholder: word, "aria-label": word, oninput: redraw };
    this.filter = h("input", filtering);
    this.hidden = h("input", { type: "checkbox", onchange: redraw });
    this.errorText = h("p", { class: "fault", role: "alert", hidden: true });
    this.nothing = h("p", { class: "nothing" }, t("variables.none"));
    this.constants = constantsPart({ t, define });
    this.allText = h("span", {});
    const showAll = () => {
      session.isAllListed = !session.isAllListed;
      redraw();
    };
    this.all = h(
      "button",
      { type: "button", class: "btn note slim values-all", onclick: showAll },
      this.allText,
      icon("caretDown", { small: true }),
    );
    this.search = h(
      "div",
      { class: "row values-search" },
      this.filter,
      h("button", { type: "button", class: "btn note slim", onclick: () => this.#save() }, "CSV"),
      h("label", { class: "check small" }, this.hidden, t("variables.hidden")),
    );
    this.parts = LISTS.map((name) => {
      const list = h("ul", { class: "values-list", "aria-label": t(`tool.${name}`) });
      return { name, list, element: h("section", {}, h("h3", { class: "cap" }, t(`tool.${name}`)), list) };
    });
    this.element = h(
      "div",
      { class: "values" },
      this.search,
      this.errorText,
      this.nothing,
      ...this.parts.map((part) => part.element),
      this.all,
      this.constants.element,
    );
  }

  /** @param {View} view */
  render(view) {
    const { t, session } = this.context;
    this.#shown = view;
    this.constants.render(view.file);
    const values = view.variables?.values ?? new Map();
    this.nothing.hidden = values.size > 0;
    if (view.code !== this.#code) this.#used = namesIn((this.#code = view.code));
    const isAll = session.isAllListed;
    this.search.hidden = !isAll;
    const { count, ...lists } = listValues({
      names: [...values.keys()],
      robot: view.target?.variables ?? [],
      watched: session.watched,
      used: this.#used,
      wanted: isAll ? this.filter.value : "",
      all: isAll,
      hidden: isAll && this.hidden.checked,
    });
    this.all.hidden = count === 0;
    setText(this.allText, isAll ? t("tool.showFewer") : t("tool.showAll", { count }));
    setAttribute(this.all, "aria-expanded", String(isAll));
    const listed = JSON.stringify(lists);
    if (listed !== this.#listed) {
      if (this.element.querySelector(".values-list input") !== null) return; // the user is typing
      this.#listed = listed;
      this.#list(lists, view);
    }
    for (const name of LISTS.flatMap((list) => lists[list])) this.#showValue(name, values.get(name));
  }

  /** Fill the lists. @param {import("./value_names.js").Listed} lists @param {View} view */
  #list(lists, { target }) {
    const known = new Map((target?.variables ?? []).map((each) => [each.name, each]));
    const focused = /** @type {HTMLElement | null} */ (this.element.querySelector(":focus"));
    for (const { name, list, element } of this.parts) {
      element.hidden = lists[name].length === 0;
      list.replaceChildren(
        ...lists[name].map((each) => {
          const row = this.#rows.get(each) ?? this.#createRow(each, known.get(each)?.help ?? "");
          this.#rows.set(each, row);
          return row.row;
        }),
      );
    }
    focused?.focus(); // reordering the rows removed the focus
  }

  /** @param {string} name @param {readonly number[] | undefined} numbers */
  #showValue(name, numbers) {
    const row = this.#rows.get(name);
    if (row === undefined) return;
    const text = numbers?.join(" ") ?? "";
    setText(row.value, text);
    setAttribute(row.value, "aria-label", this.context.t("variables.value", { name, value: text }));
    showPin(row.pin, this.context.session.watched.has(name));
  }

  /** @param {string} name @param {string} help @returns {Row} */
  #createRow(name, help) {
    const { t, session, redraw } = this.context;
    const pin = pinButton(t("variables.watch", { name }), () => {
      session.toggleWatch(name);
      redraw();
    });
    const value = h("button", { type: "button", class: "value", "data-variable": name });
    value.addEventListener("click", () => this.#edit(name, value));
    const words = name.split(/(?<=[._])/).flatMap((part) => [part, h("wbr")]); // long names break after a dot
    const row = h("li", {}, pin, h("span", { class: "value-name", title: help || name }, ...words), value);
    return { pin, value, row };
  }

  /** @param {string} name @param {HTMLElement} cell */
  #edit(name, cell) {
    const { t, announce, setVariable } = this.context;
    editValue({
      t,
      name,
      before: this.#shown?.variables?.values.get(name) ?? [],
      cell,
      send: (values) => setVariable(name, values),
      report: (problem) => {
        this.errorText.hidden = problem === "";
        if (problem !== "") setText(this.errorText, problem);
      },
      done: (values) => announce(`${name} = ${values.join(" ")}`),
    });
  }

  #save() {
    const { t } = this.context;
    const values = [...(this.#shown?.variables?.values ?? [])].flatMap(([name, numbers]) =>
      numbers.map((number, index) => [numbers.length === 1 ? name : `${name}[${index}]`, number]),
    );
    download("variables.csv", csv([[t("name"), t("value")], ...values]), "text/csv");
  }
}

/** @param {ToolContext} context @returns {Tool} */
export function valuesTool(context) {
  return new ValuesTool(context);
}
