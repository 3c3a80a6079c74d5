// Languages of the page and their texts. `{name}` in a text is replaced by a value.

import names from "./language.texts.js";
import pageTexts from "./page.texts.js";

/** @typedef {(key: string, values?: Record<string, string | number>) => string} Translate */

/** Language code → name of the language in itself, English first. */
export const LANGUAGES = Object.fromEntries(Object.entries(names).map(([code, { name }]) => [code, name]));

/** The first wanted language that is available, else English. @param {readonly string[]} wanted */
export function chooseLanguage(wanted) {
  return wanted.map((tag) => tag.slice(0, 2).toLowerCase()).find((tag) => tag in LANGUAGES) ?? "en";
}

/**
 * Texts in a language, in English where it lacks them.
 *
 * @param {string} language
 * @param {Record<string, Record<string, string>>} [tables]  by language
 * @returns {Translate}
 */
export function translator(language, tables = pageTexts) {
  const table = tables[language] ?? tables.en;
  return (key, values = {}) => {
    const text = table[key] ?? tables.en[key] ?? key;
    return text.replace(/\{(\w+)\}/g, (_all, name) => String(values[name] ?? ""));
  };
}
