// Settings that the browser keeps between visits. Where storage is forbidden, they last while the page is open.
//
// All pages of one origin share a storage, and behind a proxy the pages of all pupils have one origin. Each page therefore
// has the keys that begin with its folder, such as /p/anna/. Keys of a page at the root have no prefix.

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

/** The folder of a page, with a slash at its end. @param {string} path  of the page's address */
export function folderOf(path) {
  return path.slice(0, path.lastIndexOf("/") + 1);
}

/**
 * The part of a storage that belongs to the page of a folder.
 *
 * @param {KeyValueStore} storage
 * @param {string} folder
 * @returns {KeyValueStore}
 */
export function scopedTo(storage, folder) {
  const scope = scopeOf(folder);
  return {
    getItem: (key) => storage.getItem(scope + key),
    setItem: (key, value) => storage.setItem(scope + key, value),
    removeItem: (key) => storage.removeItem(scope + key),
  };
}

/** The prefix of the keys of a page. @param {string} folder */
function scopeOf(folder) {
  return folder === "/" ? "" : folder;
}

/** The folder of this page; in Node there is none. */
const FOLDER = folderOf(globalThis.location?.pathname ?? "/");

export const localStore = scopedTo(storageOrMap(() => localStorage), FOLDER);

/** Storage that lasts while the tab is open. */
export const tabStore = scopedTo(storageOrMap(() => sessionStorage), FOLDER);

/**
 * The name for pages of this folder of what all pages of an origin share, such as a channel.
 *
 * @param {string} name
 */
export function nameHere(name, folder = FOLDER) {
  return scopeOf(folder) + name;
}

/**
 * Call `changed` with each key of `localStore` that another tab has changed; null: it has removed all.
 *
 * @param {(key: string | null) => void} changed
 * @param {Pick<EventTarget, "addEventListener">} [target]
 */
export function followLocalStore(changed, target = globalThis, folder = FOLDER) {
  const scope = scopeOf(folder);
  target.addEventListener("storage", (event) => {
    const { key } = /** @type {StorageEvent} */ (event);
    if (key === null) changed(null);
    else if (key.startsWith(scope) && (scope !== "" || !key.startsWith("/"))) changed(key.slice(scope.length));
  });
}

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
