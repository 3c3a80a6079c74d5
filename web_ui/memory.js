// What the browser keeps of this page from visit to visit. Where it may not, it is kept as long as the page is open.

/** @typedef {Pick<Storage, "getItem" | "setItem" | "removeItem">} Memory   setItem fails where there is no room */

/** @param {() => Storage} browsers  fails where the browser forbids it @returns {Memory} */
export function memoryOf(browsers) {
  try {
    return browsers();
  } catch {
    /** @type {Map<string, string>} */ const kept = new Map();
    return {
      getItem: (key) => kept.get(key) ?? null,
      setItem: (key, value) => void kept.set(key, value),
      removeItem: (key) => void kept.delete(key),
    };
  }
}

export const memory = memoryOf(() => localStorage);

/** As long as the tab is open. */
export const tabMemory = memoryOf(() => sessionStorage);

/** Keep a choice; without room for it, it holds for this visit. @param {Memory} shelf @param {string} key @param {string} value */
export function note(shelf, key, value) {
  try {
    shelf.setItem(key, value);
  } catch {
    shelf.removeItem(key);
  }
}
