// What the browser keeps of this page from visit to visit. Where it may not, it is kept as long as the page is open.

/** @typedef {Pick<Storage, "getItem" | "setItem" | "removeItem">} KeyValueStore   setItem fails where there is no room */

/** @param {() => Storage} browsers  fails where the browser forbids it @returns {KeyValueStore} */
export function storageOrMap(browsers) {
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

export const localStore = storageOrMap(() => localStorage);

/** As long as the tab is open. */
export const tabStore = storageOrMap(() => sessionStorage);

/** Keep a choice; without room for it, it holds for this visit. @param {KeyValueStore} storage @param {string} key @param {string} value */
export function trySetItem(storage, key, value) {
  try {
    storage.setItem(key, value);
  } catch {
    storage.removeItem(key);
  }
}
