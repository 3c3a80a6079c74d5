// All text of the page, one table per language. A value may contain {name}, which is filled in.

import { de } from "./de.js";
import { en } from "./en.js";
import { fr } from "./fr.js";
import { it } from "./it.js";

/** @typedef {(key: string, values?: Record<string, string | number>) => string} Translate */

export const LANGUAGES = /** @type {Record<string, Record<string, string>>} */ ({ en, de, fr, it });

/** The first of the wanted languages that there is, else English. @param {readonly string[]} wanted */
export function chooseLanguage(wanted) {
  return wanted.map((tag) => tag.slice(0, 2).toLowerCase()).find((tag) => tag in LANGUAGES) ?? "en";
}

/** @param {string} language @returns {Translate} */
export function translator(language) {
  const table = LANGUAGES[language] ?? en;
  return (key, values = {}) => {
    const text = table[key] ?? /** @type {Record<string, string>} */ (en)[key] ?? key;
    return text.replace(/\{(\w+)\}/g, (_all, name) => String(values[name] ?? ""));
  };
}
