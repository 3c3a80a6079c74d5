// What the browser keeps for the editor: recent files, and a draft of each tab for the day the browser closes.

/**
 * @typedef {object} Kept
 * @property {string} name
 * @property {string} text
 * @property {number} time        milliseconds since 1970
 * @property {boolean} [unsaved]  in no file: it is the only copy
 */
/** @typedef {import("../browser/local_storage.js").KeyValueStore} KeyValueStore */

const RECENT_KEY = "editor.recent";
const DRAFT_KEY = "editor.draft.";
export const KEPT_FILES = 10;
/** A browser gives a page about 5 million characters. */
export const KEPT_CHARACTERS = 1_000_000;

export class FileStore {
  /** @param {KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
  }

  /** Newest first. @returns {Kept[]} */
  recent() {
    return this.#read(RECENT_KEY) ?? [];
  }

  /** @param {Kept} file  replaces a file of the same name, and no unsaved text */
  remember(file) {
    let room = KEPT_CHARACTERS;
    const others = this.recent().filter(
      ({ name, text, unsaved }) => name !== file.name || (text !== file.text && (unsaved || file.unsaved)),
    );
    const kept = [file, ...others].slice(0, KEPT_FILES).filter(({ text }) => (room -= text.length) >= 0);
    while (!this.#write(RECENT_KEY, kept) && kept.length > 0) kept.pop(); // no room for the oldest
  }

  /** @param {string} tab @returns {Kept | null} */
  draft(tab) {
    return this.#read(DRAFT_KEY + tab);
  }

  /** @param {string} tab @param {Kept | null} draft  null: there is nothing to keep */
  keepDraft(tab, draft) {
    if (draft === null) this.storage.removeItem(DRAFT_KEY + tab);
    else this.#write(DRAFT_KEY + tab, draft);
  }

  /** @param {string} key @returns {any} */
  #read(key) {
    try {
      return JSON.parse(this.storage.getItem(key) ?? "null");
    } catch {
      return null; // written by something else
    }
  }

  /** Whether there was room. @param {string} key @param {any} value */
  #write(key, value) {
    try {
      this.storage.setItem(key, JSON.stringify(value));
      return true;
    } catch {
      this.storage.removeItem(key); // full: rather nothing than an old one
      return false;
    }
  }
}
