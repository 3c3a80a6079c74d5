// Whether a thing can be pushed, and what it is like then: a switch with a sentence, and the numbers.

import { h, setText } from "../ui/dom.js";
import { numberControl } from "./fields.js";

/** @typedef {import("./fields.js").Control} Control */

/** Fields that a thing has while it can be pushed. */
export const LOAD_KEYS = ["mass_kg", "friction", "restitution"];
/** Mass of a thing that is made movable. */
const USUAL_KG = 0.1;
/** Below these parts of its weight a thing slides easily, and on paper. */
const EASY = 0.3;
const PAPER = 0.7;

/** How a thing can be pushed, as the key of a sentence. @param {Record<string, any>} values */
export function slidingWord({ mass_kg: mass = null, friction = 0 }) {
  if (mass === null) return "field.movable.fixed";
  if (friction < EASY) return "field.movable.light";
  return friction < PAPER ? "field.movable.paper" : "field.movable.heavy";
}

/**
 * @param {import("./fields.js").Setting} setting
 * @param {import("../playground/rules.js").Fields} fields
 * @returns {{ whether: Control, how: Control[] }}
 */
export function loadControls(setting, fields) {
  const { t } = setting.labels;
  const keys = LOAD_KEYS.filter((key) => key in fields);
  const input = h("input", { type: "checkbox", role: "switch", class: "switch", "data-field": "movable" });
  const sentence = h("span", { class: "small muted" });
  input.addEventListener("change", () => {
    const fixed = Object.fromEntries(keys.map((key) => [key, fields[key].default]));
    setting.commit(input.checked ? { mass_kg: USUAL_KG } : { ...fixed, mass_kg: null });
  });
  const label = h("span", { class: "grow" }, h("b", {}, t("field.movable")), sentence);
  const how = keys.map((key) => {
    const { element, update } = numberControl(setting, key, fields[key]);
    return {
      element,
      /** @param {Record<string, any>} values */
      update(values) {
        element.hidden = (values.mass_kg ?? null) === null;
        if (!element.hidden) update(values);
      },
    };
  });
  return {
    whether: {
      element: h("label", { class: "movable" }, label, input),
      update(values) {
        const mass = values.mass_kg ?? null;
        input.checked = mass !== null;
        setText(sentence, t(slidingWord(values), { grams: Math.round((mass ?? 0) * 1e4) / 10 }));
      },
    },
    how,
  };
}
