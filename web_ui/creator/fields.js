// Form controls, one per kind of field. Each has an element and updates it when values change elsewhere.

import { h, renew, setText } from "../panels/dom.js";
import { shown, taken, unitOf } from "./units.js";

/** @typedef {import("../playground/declarations.js").DeclaredField} Field */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {(values: Record<string, any>) => Phrase | null} Commit  returns the problem, or null */
/** @typedef {{ element: HTMLElement, update: (values: Record<string, any>) => void }} Control */
/**
 * @typedef {object} Setting
 * @property {import("../i18n/index.js").Translate} t
 * @property {import("./labels.js").Labels} labels
 * @property {string} [kind]   of the edited item
 * @property {(phrase: Phrase) => string} say
 * @property {Commit} commit
 * @property {() => readonly string[]} doors   names of the doors that a plate can open
 * @property {(file: File) => Promise<string | null>} readPicture
 */

let serial = 0;

/**
 * A labeled control with space for an error message.
 *
 * @param {string} label
 * @param {HTMLElement} input
 * @param {string} [unit]
 */
function labeled(label, input, unit = "") {
  const id = `field-${++serial}`;
  input.id = id;
  const problem = h("small", { class: "problem", id: `${id}-problem`, role: "alert", hidden: true });
  input.setAttribute("aria-describedby", problem.id);
  const title = unit === "" ? label : `${label} (${unit})`;
  const element = h("div", { class: "field" }, h("label", { for: id }, title), input, problem);
  return {
    element,
    /** @param {string | null} text */
    report(text) {
      problem.hidden = text === null;
      setText(problem, text ?? "");
      input.setAttribute("aria-invalid", String(text !== null));
    },
  };
}

/** @param {Setting} setting @param {string} key @param {Field} field @returns {Control} */
function numberControl({ t, labels, kind = "", say, commit }, key, field) {
  const { unit, step } = unitOf(field.unit);
  const input = h("input", { type: "number", step: "any", inputmode: "decimal", "data-field": key });
  const { element, report } = labeled(labels.field(kind, key), input, unit);
  let value = NaN;
  const take = () => {
    const wanted = taken(input.valueAsNumber, field.unit);
    const [low, high] = [field.low ?? -Infinity, field.high ?? Infinity];
    if (!(wanted >= low && wanted <= high)) {
      return report(t("problem.range", { low: shown(low, field.unit), high: shown(high, field.unit), unit }));
    }
    const problem = commit({ [key]: wanted });
    report(problem === null ? null : say(problem));
  };
  input.addEventListener("change", take);
  input.addEventListener("keydown", (event) => {
    if (event.key !== "ArrowUp" && event.key !== "ArrowDown") return;
    event.preventDefault(); // the browser's default step is 1 in any unit
    input.value = String(Math.round((input.valueAsNumber + (event.key === "ArrowUp" ? step : -step)) * 1e4) / 1e4);
    take();
  });
  return {
    element,
    update(values) {
      if (values[key] === value) return;
      value = values[key];
      input.value = value === null || value === undefined ? "" : String(shown(value, field.unit));
      report(null);
    },
  };
}

/** @param {Setting} setting @param {string} key @param {string} type  of the input element @returns {Control} */
function textControl({ labels, kind = "", say, commit }, key, type) {
  const input = h("input", { type, "data-field": key, autocomplete: "off", spellcheck: "false" });
  const { element, report } = labeled(labels.field(kind, key), input);
  let value = "";
  input.addEventListener("change", () => {
    const problem = commit({ [key]: input.value });
    report(problem === null ? null : say(problem));
  });
  return {
    element,
    update(values) {
      if ((values[key] ?? "") === value) return;
      value = values[key] ?? "";
      input.value = value;
      report(null);
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

/** Selects the door that a plate opens. @param {Setting} setting @param {string} key @returns {Control} */
function doorControl({ labels, kind = "", say, commit, doors }, key) {
  const select = h("select", { "data-field": key });
  const { element, report } = labeled(labels.field(kind, key), select);
  select.addEventListener("change", () => {
    const problem = commit({ [key]: select.value });
    report(problem === null ? null : say(problem));
  });
  let listed = "";
  return {
    element,
    update(values) {
      const names = doors();
      if (names.join() !== listed) {
        listed = names.join();
        select.replaceChildren(...names.map((name) => h("option", { value: name }, name)));
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
function pointsControl({ t, labels, kind = "", say, commit }, key, field) {
  const list = h("ol", { class: "points" });
  const problem = h("small", { class: "problem", role: "alert", hidden: true });
  const summary = h("summary");
  const element = h("details", { class: "field-points" }, summary, list, problem);
  /** @type {[number, number][]} */ let points = [];
  /** @param {[number, number][]} next */
  const take = (next) => {
    const found = commit({ [key]: next });
    problem.hidden = found === null;
    setText(problem, found === null ? "" : say(found));
  };
  /** @param {number} index @param {number} axis */
  const coordinate = (index, axis) => {
    const label = t("field.coordinate", { number: index + 1, axis: "xy"[axis] });
    const input = h("input", {
      type: "number",
      step: "any",
      "aria-label": label,
      value: shown(points[index][axis], "m"),
    });
    input.addEventListener("change", () => {
      if (Number.isNaN(input.valueAsNumber)) return;
      const value = taken(input.valueAsNumber, "m");
      take(points.map((point, at) => (at === index ? (axis === 0 ? [value, point[1]] : [point[0], value]) : point)));
    });
    return input;
  };
  /** @param {number} index */
  const row = (index) => {
    const remove = h(
      "button",
      {
        type: "button",
        class: "plain",
        "aria-label": t("field.removePoint", { number: index + 1 }),
        disabled: points.length <= (field.fewest ?? 0),
        onclick: () => take(points.filter((_, at) => at !== index)),
      },
      "×",
    );
    return h("li", {}, coordinate(index, 0), coordinate(index, 1), remove);
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
function imageControl({ t, labels, kind = "", say, commit, readPicture }, key) {
  const input = h("input", { type: "file", accept: "image/png,image/jpeg,image/svg+xml", "data-field": key });
  const { element, report } = labeled(labels.field(kind, key), input);
  input.addEventListener("change", async () => {
    const file = input.files?.[0];
    if (file === undefined) return;
    const uri = await readPicture(file);
    if (uri === null) return report(t("problem.picture", { name: file.name }));
    const problem = commit({ [key]: uri });
    report(problem === null ? null : say(problem));
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
  const element = h("div", { class: "group" }, h("label", { class: "check" }, input, setting.labels.field(setting.kind ?? "", key)), box);
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

/** Fields that an object has while it is movable. */
export const LOAD_KEYS = ["mass_kg", "friction", "restitution"];

/**
 * Edits whether an object is movable, and its mass.
 *
 * @param {Setting} setting
 * @param {import("../playground/rules.js").Fields} fields
 * @returns {Control}
 */
export function loadControl(setting, fields) {
  const input = h("input", { type: "checkbox", "data-field": "movable" });
  const keys = LOAD_KEYS.filter((key) => key in fields);
  const inner = keys.map((key) => numberControl(setting, key, fields[key]));
  const box = h("div", { class: "fields inner" }, ...inner.map(({ element }) => element));
  input.addEventListener("change", () => {
    const fixed = Object.fromEntries(keys.map((key) => [key, fields[key].default]));
    setting.commit(input.checked ? { mass_kg: 0.1 } : { ...fixed, mass_kg: null });
  });
  return {
    element: h("div", { class: "group" }, h("label", { class: "check" }, input, setting.t("field.movable")), box),
    update(values) {
      input.checked = (values.mass_kg ?? null) !== null;
      box.hidden = !input.checked;
      if (input.checked) for (const one of inner) one.update(values);
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
  if (key === "door") return doorControl(setting, key);
  if (type === "number") return numberControl(setting, key, field);
  if (type === "flag") return flagControl(setting, key);
  if (type === "points") return pointsControl(setting, key, field);
  if (type === "image") return imageControl(setting, key);
  if (type === "object") return groupControl(setting, key, field);
  return textControl(setting, key, field.format === "color" ? "color" : "text");
}
