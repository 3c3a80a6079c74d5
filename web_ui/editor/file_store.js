// Browser storage of the editor: recent files, and one draft per tab of the editor. All tabs of a browser share it: a
// draft that another one wrote, or an earlier visit, goes to the recent files before it is replaced.

import { openPages } from "../browser/other_tabs.js";

/**
 * @typedef {object} StoredFile
 * @property {string} name
 * @property {string} text
 * @property {number} time        milliseconds since 1970
 * @property {boolean} [unsaved]  not in any file: this is the only copy
 * @property {string} [writer]    of a draft: the page that wrote it
 */
/** @typedef {import("../browser/local_storage.js").KeyValueStore} KeyValueStore */
/** @typedef {import("../browser/other_tabs.js").OpenPages} OpenPages */

const RECENT_KEY = "editor.recent";
const DRAFT_KEY = "editor.draft.";
export const MAX_FILES = 10;
/** A browser allows about 5 million characters per page. */
export const MAX_CHARACTERS = 1_000_000;

export class FileStore {
  /** @param {KeyValueStore} storage @param {OpenPages} [pages]  without them, all other pages count as closed */
  constructor(storage, pages = openPages(undefined)) {
    this.storage = storage;
    this.pages = pages;
    /** Names this page among all that share the storage. */
    this.writer = Math.random().toString(36).slice(2);
    pages.join(this.writer);
    /** @type {Map<string, string>} */ this.ownDrafts = new Map(); // as they were written here, by tab
  }

  /** Recent files, newest first. @returns {StoredFile[]} */
  recent() {
    return this.#read(RECENT_KEY) ?? [];
  }

  /**
   * @param {StoredFile} file  replaces an older file of the same name, but no unsaved text, except that of a draft which
   *   the same page went on writing
   */
  addRecent(file) {
    let room = MAX_CHARACTERS;
    /** @param {StoredFile} other */
    const isContinued = ({ writer }) => writer !== undefined && writer === file.writer;
    const others = this.recent().filter(
      (other) =>
        other.name !== file.name ||
        (other.text !== file.text && (other.unsaved || file.unsaved) && !isContinued(other)),
    );
    const kept = [file, ...others].slice(0, MAX_FILES).filter(({ text }) => (room -= text.length) >= 0);
    while (!this.#write(RECENT_KEY, kept) && kept.length > 0) kept.pop(); // storage full: drop the oldest
  }

  /** @param {string} tab @returns {StoredFile | null} */
  draft(tab) {
    return this.#read(DRAFT_KEY + tab);
  }

  /**
   * Call `use` with the draft that an earlier visit has left: at once, or when the page that writes it is closed.
   *
   * @param {string} tab
   * @param {(draft: StoredFile) => void} use
   */
  whenLeft(tab, use) {
    const writer = this.draft(tab)?.writer;
    const look = () => {
      const draft = this.draft(tab);
      if (draft === null) return;
      if (draft.writer === writer) use(draft);
      else this.whenLeft(tab, use); // another page has written meanwhile
    };
    if (writer === undefined) look();
    else if (writer !== this.writer) this.pages.whenClosed(writer, look);
  }

  /**
   * Whether a change of the storage under this key concerns the draft of a tab.
   *
   * @param {string} tab
   * @param {string | null} key   null: all was removed
   */
  isOfDraft(tab, key) {
    return key === null || key === DRAFT_KEY + tab;
  }

  /** @param {string} tab @param {StoredFile | null} draft  null removes the draft */
  storeDraft(tab, draft) {
    const key = DRAFT_KEY + tab;
    if (this.storage.getItem(key) !== (this.ownDrafts.get(tab) ?? null)) {
      const other = this.draft(tab);
      if (other !== null && other.text !== draft?.text) this.addRecent({ ...other, unsaved: true });
    }
    if (draft === null) this.storage.removeItem(key);
    else this.#write(key, { ...draft, writer: this.writer });
    this.#own(tab);
  }

  /** Continue with a draft, or discard it: it goes to no other place when it is replaced. @param {string} tab @param {StoredFile} draft */
  adoptDraft(tab, draft) {
    if (this.draft(tab)?.text !== draft.text) return;
    this.#write(DRAFT_KEY + tab, { ...draft, writer: this.writer });
    this.#own(tab);
  }

  /** @param {string} tab */
  #own(tab) {
    const written = this.storage.getItem(DRAFT_KEY + tab);
    if (written === null) this.ownDrafts.delete(tab);
    else this.ownDrafts.set(tab, written);
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
