// Browser storage of the editor: recent files, and one draft per tab.

/**
 * @typedef {object} StoredFile
 * @property {string} name
 * @property {string} text
 * @property {number} time        milliseconds since 1970
 * @property {boolean} [unsaved]  not in any file: this is the only copy
 */
/** @typedef {import("../browser/local_storage.js").KeyValueStore} KeyValueStore */

const RECENT_KEY = "editor.recent";
const DRAFT_KEY = "editor.draft.";
export const MAX_FILES = 10;
/** A browser allows about 5 million characters per page. */
export const MAX_CHARACTERS = 1_000_000;

export class FileStore {
  /** @param {KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
  }

  /** Recent files, newest first. @returns {StoredFile[]} */
  recent() {
    return this.#read(RECENT_KEY) ?? [];
  }

  /** @param {StoredFile} file  replaces an older file of the same name, but no unsaved text */
  addRecent(file) {
    let room = MAX_CHARACTERS;
    const others = this.recent().filter(
      ({ name, text, unsaved }) => name !== file.name || (text !== file.text && (unsaved || file.unsaved)),
    );
    const kept = [file, ...others].slice(0, MAX_FILES).filter(({ text }) => (room -= text.length) >= 0);
    while (!this.#write(RECENT_KEY, kept) && kept.length > 0) kept.pop(); // storage full: drop the oldest
  }

  /** @param {string} tab @returns {StoredFile | null} */
  draft(tab) {
    return this.#read(DRAFT_KEY + tab);
  }

  /** @param {string} tab @param {StoredFile | null} draft  null removes the draft */
  storeDraft(tab, draft) {
    if (draft === null) this.storage.removeItem(DRAFT_KEY + tab);
    else this.#write(DRAFT_KEY + tab, draft);
  }

  /** @param {string} key @returns {any} */
  #read(key) {
    try {
      return JSON.parse(this.storage.getItem(key) ?? "null");
    } catch {
      return null; // not written by this page
    }
  }

  /** Returns whether there was enough space. @param {string} key @param {any} value */
  #write(key, value) {
    try {
      this.storage.setItem(key, JSON.stringify(value));
      return true;
    } catch {
      this.storage.removeItem(key); // storage full: no value is better than an outdated one
      return false;
    }
  }
}
