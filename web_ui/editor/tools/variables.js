// All variables with live values; a click edits one, a star watches and plots it.

import { h, setAttribute, setText } from "../../ui/dom.js";
import { download } from "../download.js";
import { csv, parseNumbers } from "../numbers.js";

/** @param {import("./index.js").ToolContext} context @returns {import("./index.js").Tool} */
export function variablesTool({ t, session, announce, setVariable, redraw }) {
  const filter = h("input", { type: "search", placeholder: t("filter"), "aria-label": t("filter"), oninput: redraw });
  const hidden = h("input", { type: "checkbox", onchange: redraw });
  const body = h("tbody");
  const errorText = h("p", { class: "fault", role: "alert", hidden: true });
  const nothing = h("p", { class: "nothing" }, t("variables.none"));
  /** @type {Map<string, { star: HTMLElement, value: HTMLElement, row: HTMLElement }>} */ const rows = new Map();
  /** @type {import("./index.js").View | null} */ let shown = null;
  let listed = "";

  const save = h(
    "button",
    {
      type: "button",
      onclick: () => {
        const values = [...(shown?.variables?.values ?? [])].flatMap(([name, numbers]) =>
          numbers.map((number, index) => [numbers.length === 1 ? name : `${name}[${index}]`, number]),
        );
        download("variables.csv", csv([[t("name"), t("value")], ...values]), "text/csv");
      },
    },
    "CSV",
  );

  /** @param {string} name @param {HTMLElement} cell */
  const edit = (name, cell) => {
    const before = shown?.variables?.values.get(name) ?? [];
    const input = h("input", { type: "text", value: before.join(" "), "aria-label": t("variables.edit", { name }) });
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

  /** @param {string} name @param {string} help */
  const rowOf = (name, help) => {
    const star = h("button", {
      type: "button",
      class: "plain star",
      "aria-label": t("variables.watch", { name }),
      title: t("variables.watch", { name }),
      onclick: () => {
        session.toggleWatch(name);
        redraw();
      },
    });
    const value = h("button", { type: "button", class: "plain value", "data-variable": name });
    value.addEventListener("click", () => edit(name, value));
    const row = h(
      "tr",
      {},
      h("td", { class: "mark" }, star),
      h("th", { scope: "row", title: help }, name),
      h("td", {}, value),
    );
    return { star, value, row };
  };

  const element = h(
    "div",
    { class: "variables" },
    h("div", { class: "row" }, filter, h("label", {}, hidden, " ", t("variables.hidden")), save),
    errorText,
    nothing,
    h("div", { class: "scroll" }, h("table", {}, body)),
  );
  return {
    name: "variables",
    element,
    render(view) {
      shown = view;
      const values = view.variables?.values ?? new Map();
      nothing.hidden = values.size > 0;
      const known = new Map((view.target?.variables ?? []).map((each) => [each.name, each]));
      const wanted = filter.value.trim().toLowerCase();
      const names = [...values.keys()].filter((name) => {
        const secret = known.get(name)?.hidden ?? /(^|\.)_/.test(name);
        return name.toLowerCase().includes(wanted) && (hidden.checked || !secret);
      });
      const sorted = [
        ...names.filter((name) => session.watched.has(name)),
        ...names.filter((name) => !session.watched.has(name) && !known.has(name)), // the program's own
        ...names.filter((name) => !session.watched.has(name) && known.has(name)),
      ];
      if (sorted.join() !== listed) {
        if (body.querySelector("input") !== null) return; // the user is typing
        listed = sorted.join();
        const focused = /** @type {HTMLElement | null} */ (body.querySelector(":focus"));
        body.replaceChildren(
          ...sorted.map((name) => {
            const row = rows.get(name) ?? rowOf(name, known.get(name)?.help ?? "");
            rows.set(name, row);
            return row.row;
          }),
        );
        focused?.focus(); // reordering the rows removed the focus
      }
      for (const name of sorted) {
        const row = rows.get(name);
        if (row === undefined) continue;
        const text = values.get(name)?.join(" ") ?? "";
        setText(row.value, text);
        setAttribute(row.value, "aria-label", t("variables.value", { name, value: text }));
        const watched = session.watched.has(name);
        setText(row.star, watched ? "★" : "☆");
        setAttribute(row.star, "aria-pressed", String(watched));
      }
    },
  };
}
