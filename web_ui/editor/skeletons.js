// Three programs to begin with. Their comments are texts of the page: `{key}` in a file of `skeletons/` is one.

import FILES from "./skeletons.texts.js";

/** In the order in which they are offered. */
export const SKELETONS = /** @type {const} */ (["button", "avoid", "line"]);

/**
 * @param {string} name
 * @param {import("../i18n/index.js").Translate} t
 */
export function skeletonText(name, t) {
  return FILES[/** @type {typeof SKELETONS[number]} */ (name)].replace(/\{([\w.]+)\}/g, (_all, key) => t(key));
}
