// Settings that the browser keeps between visits. Where storage is forbidden, they last while the page is open.

/** @typedef {Pick<Storage, "getItem" | "setItem" | "removeItem">} KeyValueStore   setItem throws when the storage is full */

/** @param {() => Storage} browsers  throws where the browser forbids storage @returns {KeyValueStore} */
export function storageOrMap(browsers) {
  try {
    return browsers();
  } catch {
    /** @type {Map<string, string>} */ const values = new Map();
    return {
      getItem: (key) => values.get(key) ?? null,
      setItem: (key, value) => void values.set(key, value),
      removeItem: (key) => void values.delete(key),
    };
  }
}

export const localStore = storageOrMap(() => localStorage);

/** Storage that lasts while the tab is open. */
export const tabStore = storageOrMap(() => sessionStorage);

/**
 * Store a setting. If the storage is full, remove the old value instead: the setting then lasts for this visit only.
 *
 * @param {KeyValueStore} storage
 * @param {string} key
 * @param {string} value
 */
export function trySetItem(storage, key, value) {
  try {
    storage.setItem(key, value);
  } catch {
    storage.removeItem(key);
  }
}
