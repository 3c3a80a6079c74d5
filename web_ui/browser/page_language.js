// The language of the page: the chosen one, else the browser's. The browser remembers the choice.

import { chooseLanguage, translator } from "../i18n/index.js";
import { TEXTS } from "../i18n/page_texts.js";
import { localStore, trySetItem } from "./local_storage.js";

/** @typedef {import("../i18n/page_texts.js").TextFile} TextFile */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const KEY = "language";

export class PageLanguage {
  /** @param {readonly string[]} preferred  languages of the browser */
  constructor(preferred) {
    this.language = chooseLanguage([localStore.getItem(KEY) ?? "", ...preferred]);
    /** @type {Map<TextFile, Translate>} */ this.translators = new Map();
  }

  /** The texts of one file in the current language. @type {(file: TextFile) => Translate} */
  text = (file) => {
    const known = this.translators.get(file) ?? translator(this.language, TEXTS[file]);
    this.translators.set(file, known);
    return known;
  };

  /** @param {string} language */
  choose(language) {
    this.language = language;
    this.translators.clear();
    trySetItem(localStore, KEY, language);
  }
}
