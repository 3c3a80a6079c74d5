// Live values: the watched ones, those of the program, those of the robot, and the constants of the file. A click edits
// a value, a pin watches and plots it.

import { download } from "../../browser/download.js";
import { h, setAttribute, setText } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { csv, parseNumbers } from "../numbers.js";
import { constantsPart } from "./constants.js";
import { pinButton, showPin } from "./pin.js";
import { listValues, namesIn } from "./value_names.js";

/** @typedef {{ pin: HTMLElement, value: HTMLElement, row: HTMLElement }} Row */

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function valuesTool({ t, session, announce, setVariable, define, redraw }) {
  const word = t("filter");
  const filter = h("input", { type: "search", class: "input", placeholder: word, "aria-label": word, oninput: redraw });
  const hidden = h("input", { type: "checkbox", onchange: redraw });
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  const nothing = h("p", { class: "nothing" }, t("variables.none"));
  const constants = constantsPart({ t, define });
  /** @type {Map<string, Row>} */ const rows = new Map();
  /** @type {import("./index.js").View | null} */ let shown = null;
  let listed = "";
  let code = "";
  let used = namesIn(code);

  const save = h(
    "button",
    {
      type: "button",
      class: "btn note slim",
      onclick: () => {
        const values = [...(shown?.variables?.values ?? [])].flatMap(([name, numbers]) =>
          numbers.map((number, index) => [numbers.length === 1 ? name : `${name}[${index}]`, number]),
        );
        download("variables.csv", csv([[t("name"), t("value")], ...values]), "text/csv");
      },
    },
    "CSV",
  );
  const allText = h("span", {});
  const all = h(
    "button",
    {
      type: "button",
      class: "btn note slim values-all",
      onclick: () => {
        session.isAllListed = !session.isAllListed;
        redraw();
      },
    },
    allText,
    icon("caretDown", { small: true }),
  );
  const search = h(
    "div",
    { class: "row values-search" },
    filter,
    save,
    h("label", { class: "check small" }, hidden, t("variables.hidden")),
  );
  const parts = /** @type {const} */ (["watched", "own", "robot"]).map((name) => {
    const list = h("ul", { class: "values-list", "aria-label": t(`tool.${name}`) });
    return { name, list, element: h("section", {}, h("h3", { class: "cap" }, t(`tool.${name}`)), list) };
  });

  /** @param {string} name @param {HTMLElement} cell */
  const edit = (name, cell) => {
    const before = shown?.variables?.values.get(name) ?? [];
    const label = t("variables.edit", { name });
    const input = h("input", { type: "text", class: "input", value: before.join(" "), "aria-label": label });
    let open = true;
    const close = (/** @type {boolean} */ focus) => {
      if (!open) return;
      open = false; // removing the element blurs it, which calls this function again
      errorText.hidden = true;
      input.replaceWith(cell);
      if (focus) cell.focus();
    };
    const showError = (/** @type {string} */ text) => {
      errorText.hidden = false;
      setText(errorText, `${name}: ${text}`);
      input.setAttribute("aria-invalid", "true");
    };
    input.addEventListener("keydown", async ({ key }) => {
      if (key === "Escape") close(true);
      if (key !== "Enter") return;
      const { values, problem } = parseNumbers(input.value, before.length);
      if (values === null) return showError(t(problem.key, problem.values));
      const { ok, message } = await setVariable(name, values);
      if (!ok) return showError(message);
      close(true);
      announce(`${name} = ${values.join(" ")}`);
    });
    input.addEventListener("blur", () => close(false));
    cell.replaceWith(input);
    input.select();
    input.focus();
  };

  /** @param {string} name @param {string} help @returns {Row} */
  const rowOf = (name, help) => {
    const pin = pinButton(t("variables.watch", { name }), () => {
      session.toggleWatch(name);
      redraw();
    });
    const value = h("button", { type: "button", class: "value", "data-variable": name });
    value.addEventListener("click", () => edit(name, value));
    const words = name.split(/(?<=[._])/).flatMap((part) => [part, h("wbr")]); // long names break after a dot
    const row = h("li", {}, pin, h("span", { class: "value-name", title: help || name }, ...words), value);
    return { pin, value, row };
  };

  const element = h(
    "div",
    { class: "values" },
    search,
    errorText,
    nothing,
    ...parts.map((part) => part.element),
    all,
    constants.element,
  );
  return {
    name: "values",
    element,
    render(view) {
      shown = view;
      constants.render(view.file);
      const values = view.variables?.values ?? new Map();
      nothing.hidden = values.size > 0;
      const known = new Map((view.target?.variables ?? []).map((each) => [each.name, each]));
      if (view.code !== code) used = namesIn((code = view.code));
      const isAll = session.isAllListed;
      search.hidden = !isAll;
      const { count, ...lists } = listValues({
        names: [...values.keys()],
        robot: view.target?.variables ?? [],
        watched: session.watched,
        used,
        wanted: isAll ? filter.value : "",
        all: isAll,
        hidden: isAll && hidden.checked,
      });
      all.hidden = count === 0;
      setText(allText, isAll ? t("tool.showFewer") : t("tool.showAll", { count }));
      setAttribute(all, "aria-expanded", String(isAll));
      if (JSON.stringify(lists) !== listed) {
        if (element.querySelector(".values-list input") !== null) return; // the user is typing
        listed = JSON.stringify(lists);
        const focused = /** @type {HTMLElement | null} */ (element.querySelector(":focus"));
        for (const { name, list, element: part } of parts) {
          part.hidden = lists[name].length === 0;
          list.replaceChildren(
            ...lists[name].map((each) => {
              const row = rows.get(each) ?? rowOf(each, known.get(each)?.help ?? "");
              rows.set(each, row);
              return row.row;
            }),
          );
        }
        focused?.focus(); // reordering the rows removed the focus
      }
      for (const name of [...lists.watched, ...lists.own, ...lists.robot]) {
        const row = rows.get(name);
        if (row === undefined) continue;
        const text = values.get(name)?.join(" ") ?? "";
        setText(row.value, text);
        setAttribute(row.value, "aria-label", t("variables.value", { name, value: text }));
        showPin(row.pin, session.watched.has(name));
      }
    },
  };
}
