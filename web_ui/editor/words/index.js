// Texts of the editor, one table per language, loaded together with it.

import { de, phrases as dePhrases } from "./de.js";
import { en, phrases as enPhrases } from "./en.js";
import { fr, phrases as frPhrases } from "./fr.js";
import { it, phrases as itPhrases } from "./it.js";

export const WORDS = /** @type {Record<string, Record<string, string>>} */ ({ en, de, fr, it });
export const PHRASES = /** @type {Record<string, Record<string, string>>} */ ({
  en: enPhrases,
  de: dePhrases,
  fr: frPhrases,
  it: itPhrases,
});
