// Texts of the playground creator, one table per language, loaded together with it.

import { de } from "./de.js";
import { en } from "./en.js";
import { fr } from "./fr.js";
import { it } from "./it.js";

export const WORDS = /** @type {Record<string, Record<string, string>>} */ ({ en, de, fr, it });
