// The language of the page: the chosen one, else the browser's. The browser remembers the choice.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { chooseLanguage, translator } from "./index.js";

const KEY = "language";

export class PageLanguage {
  /** @param {readonly string[]} preferred  languages of the browser */
  constructor(preferred) {
    this.language = chooseLanguage([localStore.getItem(KEY) ?? "", ...preferred]);
    this.translate = translator(this.language);
  }

  /** A text in the current language. @type {import("./index.js").Translate} */
  t = (key, values) => this.translate(key, values);

  /** @param {string} language */
  choose(language) {
    this.language = language;
    this.translate = translator(language);
    trySetItem(localStore, KEY, language);
  }
}
