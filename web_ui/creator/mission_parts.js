// What the parts of the form of the mission share: buttons, and values in words.

import { FACTS } from "../playground/mission.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("../playground/document.js").Playground} Playground */
/**
 * @typedef {object} Part   what each part of the form gets
 * @property {Omit<import("./fields.js").Setting, "commit">} setting
 * @property {() => Playground} playground
 * @property {(values: Partial<Mission>) => import("./fields.js").Phrase | null} change
 */

/** @param {import("../ui/icons.js").IconName} drawing @param {string} label @param {string} name @param {() => void} act */
export function verb(drawing, label, name, act) {
  return h("button", { type: "button", class: "btn line icon", title: label, "aria-label": label, "data-verb": name, onclick: act }, icon(drawing, { small: true }));
}

/** A button with its words. @param {import("../ui/icons.js").IconName} drawing @param {string} words @param {string} name @param {() => unknown} act */
export function wordedVerb(drawing, words, name, act) {
  return h("button", { type: "button", class: "btn line", "data-verb": name, onclick: act }, icon(drawing, { small: true }), words);
}

/** A value as a word of the page, such as a color or that none was chosen; a name stays. @param {Translate} t @param {any} value */
export function wordFor(t, value) {
  const key = value === "" || value === null ? "mission.anything" : `choice.${value}`;
  const word = t(key);
  return word === key ? String(value) : word;
}

/** Values of fields that are left out. @param {string} kind */
export function defaultsOf(kind) {
  return Object.fromEntries(Object.entries(FACTS[kind]).map(([key, field]) => [key, field.default ?? ""]));
}

/** @param {string} text */
export function oneLine(text) {
  return text.replace(/[\u0000-\u001f\u007f]+/g, " ").trim();
}

/**
 * One of several, as a list to choose from.
 *
 * @param {string} key
 * @param {string} label
 * @param {readonly string[]} values
 * @param {string} chosen
 * @param {(value: string) => string} shown
 * @param {(value: string) => void} choose
 */
export function kindChoice(key, label, values, chosen, shown, choose) {
  const select = h("select", { class: "input grow", "aria-label": label, "data-field": key });
  select.append(...values.map((value) => h("option", { value, selected: value === chosen }, shown(value))));
  select.addEventListener("change", () => choose(select.value));
  return select;
}

/** A control as a list, empty if there is none. @param {import("./fields.js").Control | null} one */
export const present = (one) => (one === null ? [] : [one]);
/** The list without the entry of a place. @template T @param {readonly T[]} list @param {number} index */
export const without = (list, index) => list.filter((_, at) => at !== index);
/** The list with another entry at a place. @template T @param {readonly T[]} list @param {number} index @param {T} entry */
export const replaced = (list, index, entry) => list.map((one, at) => (at === index ? entry : one));
