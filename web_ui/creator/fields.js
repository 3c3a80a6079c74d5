// Form controls, one per kind of field. Each has an element and updates it when values change elsewhere.

import { toDisplay, toFile, unitOf } from "../playground/units.js";
import { h, renew, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("../playground/declarations.js").DeclaredField} Field */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {(values: Record<string, any>) => Phrase | null} Commit  returns the problem, or null */
/** @typedef {{ element: HTMLElement, update: (values: Record<string, any>) => void }} Control */
/**
 * @typedef {object} Setting
 * @property {import("../playground/labels.js").Labels} labels
 * @property {string} [kind]   of the edited item
 * @property {Commit} commit
 * @property {() => readonly string[]} doors   names of the doors that a plate can open
 * @property {(file: File) => Promise<string | null>} readPicture
 */

let serial = 0;

/**
 * A labeled input with space for an error message.
 *
 * @param {Setting} setting
 * @param {string} key
 * @param {HTMLInputElement | HTMLSelectElement} input
 * @param {string} [unit]
 */
function labeled({ labels, kind = "", commit }, key, input, unit = "") {
  const id = `field-${++serial}`;
  input.id = id;
  const problem = h("small", { class: "problem", id: `${id}-problem`, role: "alert", hidden: true });
  input.setAttribute("aria-describedby", problem.id);
  const label = h("label", { class: "cap", for: id }, labels.field(kind, key));
  if (unit !== "") label.append(h("span", { class: "vh" }, ` (${unit})`));
  const box = unit === "" ? input : h("span", { class: "with-unit" }, input, h("span", { class: "unit", "aria-hidden": "true" }, unit));
  const element = h("div", { class: "field" }, label, box, problem);
  /** @param {string | null} text */
  const report = (text) => {
    problem.hidden = text === null;
    setText(problem, text ?? "");
    input.setAttribute("aria-invalid", String(text !== null));
  };
  let shown = input.value;
  input.addEventListener("change", () => (shown = input.value));
  return {
    element,
    report,
    /** Show a value, which may be that of an earlier change: what has been typed since stays. @param {string} text */
    show(text) {
      if (input.value !== shown) return;
      input.value = shown = text;
      report(null);
    },
    /** Change the value, and show why it was rejected. @param {any} value */
    apply(value) {
      const rejected = commit({ [key]: value });
      report(rejected === null ? null : labels.text(rejected));
    },
  };
}

/** @param {Setting} setting @param {string} key @param {Field} field @returns {Control} */
export function numberControl(setting, key, field) {
  const { unit, step } = unitOf(field.unit);
  const input = h("input", { type: "number", step: "any", inputmode: "decimal", "data-field": key });
  const { element, report, show, apply } = labeled(setting, key, input, unit);
  let value = NaN;
  const applyInput = () => {
    if (field.nullable && input.value === "" && !input.validity.badInput) return apply(null);
    const wanted = toFile(input.valueAsNumber, field.unit);
    const [low, high] = [field.low ?? -Infinity, field.high ?? Infinity];
    if (wanted >= low && wanted <= high) return apply(wanted);
    const limits = { low: toDisplay(low, field.unit), high: toDisplay(high, field.unit), unit };
    report(setting.labels.t("problem.range", limits));
  };
  input.addEventListener("change", applyInput);
  input.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault(); // the browser's default step is 1 in any unit
    input.value = String(Math.round((input.valueAsNumber + (event.key === "ArrowUp" ? step : -step)) * 1e4) / 1e4);
    input.dispatchEvent(new Event("change"));
  });
  return {
    element,
    update(values) {
      if (values[key] === value) return;
      value = values[key];
      show(value === null || value === undefined ? "" : String(toDisplay(value, field.unit)));
    },
  };
}

/** @param {Setting} setting @param {string} key @param {string} type  of the input element @returns {Control} */
function textControl(setting, key, type) {
  const input = h("input", { type, "data-field": key, autocomplete: "off", spellcheck: "false" });
  const { element, show, apply } = labeled(setting, key, input);
  let value = "";
  input.addEventListener("change", () => apply(input.value));
  return {
    element,
    update(values) {
      if ((values[key] ?? "") === value) return;
      value = values[key] ?? "";
      show(value);
    },
  };
}

/** @param {Setting} setting @param {string} key @returns {Control} */
function flagControl({ labels, kind = "", commit }, key) {
  const input = h("input", { type: "checkbox", "data-field": key });
  input.addEventListener("change", () => commit({ [key]: input.checked }));
  return {
    element: h("label", { class: "check" }, input, labels.field(kind, key)),
    update: (values) => (input.checked = values[key] === true),
  };
}

/**
 * Selects one of some values.
 *
 * @param {Setting} setting
 * @param {string} key
 * @param {() => readonly string[]} choices
 * @param {(value: string) => string} [shown]   how a value is called
 * @returns {Control}
 */
export function choiceControl(setting, key, choices, shown = (value) => value) {
  const select = h("select", { "data-field": key });
  const { element, apply } = labeled(setting, key, select);
  select.addEventListener("change", () => apply(select.value));
  let listed = "";
  return {
    element,
    update(values) {
      const names = choices();
      if (names.join() !== listed) {
        listed = names.join();
        select.replaceChildren(...names.map((name) => h("option", { value: name }, shown(name))));
      }
      select.value = values[key];
    },
  };
}

/**
 * Edits a list of points as pairs of numbers; the view has handles for them.
 *
 * @param {Setting} setting
 * @param {string} key
 * @param {Field} field
 * @returns {Control}
 */
function pointsControl({ labels, kind = "", commit }, key, field) {
  const { t } = labels;
  const list = h("ol", { class: "points" });
  const problem = h("small", { class: "problem", role: "alert", hidden: true });
  const summary = h("summary");
  const element = h("details", { class: "field-points" }, summary, list, problem);
  /** @type {[number, number][]} */ let points = [];
  /** @param {[number, number][]} next */
  const apply = (next) => {
    const rejected = commit({ [key]: next });
    problem.hidden = rejected === null;
    setText(problem, rejected === null ? "" : labels.text(rejected));
  };
  /** @param {number} index @param {number} axis */
  const coordinate = (index, axis) => {
    const label = t("field.coordinate", { number: index + 1, axis: "xy"[axis] });
    const input = h("input", {
      type: "number",
      step: "any",
      "aria-label": label,
      value: toDisplay(points[index][axis], "m"),
    });
    input.addEventListener("change", () => {
      if (Number.isNaN(input.valueAsNumber)) return;
      const value = toFile(input.valueAsNumber, "m");
      apply(points.map((point, at) => (at === index ? (axis === 0 ? [value, point[1]] : [point[0], value]) : point)));
    });
    return input;
  };
  /** @param {number} index */
  const row = (index) => {
    const remove = h(
      "button",
      {
        type: "button",
        class: "btn icon",
        title: t("field.removePoint", { number: index + 1 }),
        "aria-label": t("field.removePoint", { number: index + 1 }),
        disabled: points.length <= (field.fewest ?? 0),
        onclick: () => apply(points.filter((_, at) => at !== index)),
      },
      icon("close", { small: true }),
    );
    return h("li", {}, h("span", { class: "num" }, String(index + 1)), coordinate(index, 0), coordinate(index, 1), remove);
  };
  return {
    element,
    update(values) {
      if (values[key] === points) return;
      points = values[key] ?? [];
      element.hidden = points.length === 0;
      setText(summary, `${labels.field(kind, key)} (${points.length})`);
      renew(
        list,
        points.map((_, index) => row(index)),
      );
    },
  };
}

/** Replaces the image. @param {Setting} setting @param {string} key @returns {Control} */
function imageControl(setting, key) {
  const input = h("input", { type: "file", accept: "image/png,image/jpeg,image/svg+xml", "data-field": key });
  const { element, report, apply } = labeled(setting, key, input);
  input.addEventListener("change", async () => {
    const file = input.files?.[0];
    if (file === undefined) return;
    const uri = await setting.readPicture(file);
    if (uri === null) report(setting.labels.t("problem.picture", { name: file.name }));
    else apply(uri);
  });
  return { element, update: () => {} };
}

/**
 * Edits an optional group: walls, a pen.
 *
 * @param {Setting} setting
 * @param {string} key
 * @param {Field} field
 * @returns {Control}
 */
function groupControl(setting, key, field) {
  /** @type {Record<string, any> | null} */ let group = null;
  const input = h("input", { type: "checkbox", "data-field": key });
  const inner = Object.entries(field.fields ?? {}).map(([name, member]) =>
    control({ ...setting, commit: (values) => setting.commit({ [key]: { ...group, ...values } }) }, name, member),
  );
  const box = h("div", { class: "fields inner" }, ...inner.flatMap((one) => (one === null ? [] : [one.element])));
  input.addEventListener("change", () => setting.commit({ [key]: input.checked ? (group ?? {}) : null }));
  const label = setting.labels.field(setting.kind ?? "", key);
  const element = h("div", { class: "group" }, h("label", { class: "check" }, input, label), box);
  return {
    element,
    update(values) {
      const now = values[key] ?? null;
      input.checked = now !== null;
      box.hidden = now === null;
      group = now;
      if (now !== null) for (const one of inner) one?.update({ ...now, color: now.color ?? values.color });
    },
  };
}

/**
 * The control for a field.
 *
 * @param {Setting} setting
 * @param {string} key
 * @param {Field} field
 * @returns {Control | null}
 */
export function control(setting, key, field) {
  const { type } = field;
  if (key === "door") return choiceControl(setting, key, setting.doors);
  if (type === "number") return numberControl(setting, key, field);
  if (type === "flag") return flagControl(setting, key);
  if (type === "points") return pointsControl(setting, key, field);
  if (type === "image") return imageControl(setting, key);
  if (type === "object") return groupControl(setting, key, field);
  return textControl(setting, key, field.format === "color" ? "color" : "text");
}
