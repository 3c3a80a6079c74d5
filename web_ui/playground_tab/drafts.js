// The playgrounds that were built on this device. The browser keeps each until it is removed. No DOM.

/** @typedef {import("../browser/local_storage.js").KeyValueStore} KeyValueStore */
/** @typedef {{ id: string, title: string, inFile: boolean }} Draft   inFile: whether a file has the same content */
/**
 * @typedef {Draft & { writer?: string, of?: string }} Entry
 *   writer: the page that wrote it; of: the draft of which it is the version of this writer
 */

const INDEX_KEY = "creator.drafts";
/** @param {string} id */
const textKey = (id) => `creator.draft.${id}`;
/** The only draft that earlier versions kept, and whether a file had it. */
const FORMER_KEY = "creator.draft";
const FORMER_SAVED_KEY = "creator.draftSaved";
/** So many characters of a title are listed. */
const LONGEST_TITLE = 200;

export class Drafts {
  /** @param {KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
    /** Names this page among all that share the storage. */
    this.writer = Math.random().toString(36).slice(2);
    /** @type {Map<string, string>} */ this.known = new Map(); // as they were read or kept here, by id
    /** Number of changes, so that a list knows when it is outdated. */
    this.version = 0;
    this.#adoptFormer();
  }

  /** All drafts, the one that was changed last first. @returns {Draft[]} */
  list() {
    return this.#entries().map(({ id, title, inFile }) => ({ id, title, inFile }));
  }

  /** @returns {Entry[]} */
  #entries() {
    try {
      const listed = JSON.parse(this.storage.getItem(INDEX_KEY) ?? "[]");
      return Array.isArray(listed) ? listed.filter(isDraft) : [];
    } catch {
      return [];
    }
  }

  /** A name that no draft has, not even of another window. */
  newId() {
    return Math.random().toString(36).slice(2, 12);
  }

  /** @param {string} id */
  has(id) {
    return this.list().some((one) => one.id === id);
  }

  /** The text of a draft; null: there is none. @param {string} id */
  read(id) {
    const text = this.storage.getItem(textKey(id));
    if (text !== null) this.known.set(id, text);
    return text;
  }

  /**
   * Keep a draft; what another tab has made of it since stays as a draft of its own. Throws when the storage is full;
   * then it is gone: none is better than an outdated one.
   *
   * @param {Draft & { text: string }} draft
   */
  keep({ id, title, inFile, text }) {
    try {
      const present = this.storage.getItem(textKey(id));
      if (present !== null && present !== text && present !== this.known.get(id)) this.#split(id, present);
      this.known.set(id, text);
      this.storage.setItem(textKey(id), text);
      const entry = { id, title: title.slice(0, LONGEST_TITLE), inFile, writer: this.writer };
      this.#write([entry, ...this.#others(id)]);
    } catch (error) {
      this.remove(id);
      throw error;
    }
  }

  /** @param {string} id */
  remove(id) {
    this.storage.removeItem(textKey(id));
    const others = this.#others(id);
    if (others.length === 0) {
      this.storage.removeItem(INDEX_KEY); // works in a full storage too
      this.version += 1;
    } else this.#write(others);
  }

  /** Keep the version of another tab, in place of its earlier one. @param {string} id @param {string} text */
  #split(id, text) {
    const entries = this.#entries();
    const draft = entries.find((one) => one.id === id);
    if (draft === undefined) return;
    const earlier = entries.find(({ of, writer }) => of === id && writer !== undefined && writer === draft.writer);
    const other = earlier?.id ?? this.newId();
    this.storage.setItem(textKey(other), text);
    this.#write([{ ...draft, id: other, of: id }, ...this.#others(other)]);
  }

  /** @param {string} id */
  #others(id) {
    return this.#entries().filter((one) => one.id !== id);
  }

  /** @param {Entry[]} entries */
  #write(entries) {
    this.storage.setItem(INDEX_KEY, JSON.stringify(entries));
    this.version += 1;
  }

  #adoptFormer() {
    const text = this.storage.getItem(FORMER_KEY);
    if (text === null) return;
    const inFile = this.storage.getItem(FORMER_SAVED_KEY) === "true";
    this.storage.removeItem(FORMER_KEY);
    this.storage.removeItem(FORMER_SAVED_KEY);
    try {
      this.keep({ id: this.newId(), title: String(JSON.parse(text).title ?? ""), inFile, text });
    } catch {
      // It was no playground, or the storage is full.
    }
  }
}

/** @param {any} value @returns {value is Draft} */
function isDraft(value) {
  return typeof value?.id === "string" && typeof value.title === "string" && typeof value.inFile === "boolean";
}
