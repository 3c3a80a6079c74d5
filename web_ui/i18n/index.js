// Texts of the page, one table per language. `{name}` in a text is replaced by a value.

import { de } from "./de.js";
import { en } from "./en.js";
import { fr } from "./fr.js";
import { it } from "./it.js";

/** @typedef {(key: string, values?: Record<string, string | number>) => string} Translate */

export const LANGUAGES = /** @type {Record<string, Record<string, string>>} */ ({ en, de, fr, it });

/** The first wanted language that is available, else English. @param {readonly string[]} wanted */
export function chooseLanguage(wanted) {
  return wanted.map((tag) => tag.slice(0, 2).toLowerCase()).find((tag) => tag in LANGUAGES) ?? "en";
}

/** @param {string} language @param {Record<string, Record<string, string>>} [tables] @returns {Translate} */
export function translator(language, tables = LANGUAGES) {
  const table = tables[language] ?? tables.en;
  return (key, values = {}) => {
    const text = table[key] ?? tables.en[key] ?? key;
    return text.replace(/\{(\w+)\}/g, (_all, name) => String(values[name] ?? ""));
  };
}
