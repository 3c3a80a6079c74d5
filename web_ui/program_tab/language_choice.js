// In which language the open document is shown. The file decides: one with a picture or blocks belongs to the language
// that made them, any other file to text. No DOM.

import { isPython } from "../browser/python_name.js";

/** @typedef {import("../hosts/program_host.js").Language} Language */
/** @typedef {import("../editor/workspace.js").Workspace} Workspace */
/**
 * A picture that left its file.
 *
 * @typedef {object} Detached
 * @property {string} document   which one
 * @property {string} language
 * @property {string} before     the file with the picture
 * @property {string} after      the file as it was left
 */
/**
 * What to say about the language of the document:
 *
 * - `made`: the text is made from a picture, and cannot be edited
 * - `detached`: the picture has left the file, which can be undone
 * - `ask`: the text has changed since; bringing the picture back takes these changes away
 *
 * @typedef {{ kind: "made" | "detached" | "ask", language: string }} Notice
 */

export const TEXT = "text";

/**
 * The language that a file belongs to: the first one that holds it.
 *
 * @template {Pick<Language, "id" | "holds">} L
 * @param {{ name: string, text: string }} file
 * @param {readonly L[]} languages
 * @returns {string}
 */
export function languageOf({ name, text }, languages) {
  return languages.find(({ holds }) => holds(text, name))?.id ?? TEXT;
}

/**
 * The language that opens files of another program with this ending; null: none does.
 *
 * @template {Pick<Language, "imports">} L
 * @param {{ name: string }} file
 * @param {readonly L[]} languages
 */
export function importerOf({ name }, languages) {
  return languages.find(({ imports = [] }) => imports.some((ending) => name.toLowerCase().endsWith(ending))) ?? null;
}

export class LanguageChoice {
  /** The document whose generated text is shown. */
  #asText = "";
  /** @type {Detached | null} */ #detached = null;
  #isAsking = false;

  /** @param {{ workspace: Workspace, languages: readonly Pick<Language, "id" | "holds">[] }} options */
  constructor({ workspace, languages }) {
    this.workspace = workspace;
    this.languages = languages;
  }

  get #document() {
    const { tab, current } = this.workspace;
    return `${tab} ${current.name}`;
  }

  /** The language that the document belongs to. */
  get made() {
    return languageOf(this.workspace.current, this.languages);
  }

  /** The language in which it is shown. */
  get shown() {
    return this.#asText === this.#document ? TEXT : this.made;
  }

  /** Whether the text that is shown is made from a picture. */
  get isReadOnly() {
    return this.shown === TEXT && this.made !== TEXT;
  }

  /** @returns {Detached | null} the picture that can be brought back */
  get #undoable() {
    const detached = this.#detached;
    return detached?.document === this.#document && this.made === TEXT ? detached : null;
  }

  /** @returns {Notice | null} */
  get notice() {
    if (this.isReadOnly) return { kind: "made", language: this.made };
    const detached = this.#undoable;
    return detached && { kind: this.#isAsking ? "ask" : "detached", language: detached.language };
  }

  /**
   * The user wants to see the document in a language. Returns what follows: it is shown in that language, the user is
   * asked whether changes may be given up, or only a new program can be in that language.
   *
   * @param {string} language
   * @returns {"shown" | "ask" | "new"}
   */
  choose(language) {
    this.#isAsking = false;
    if (language === this.made || (language === TEXT && !isPython(this.workspace.current.name))) {
      this.#asText = language === this.made ? "" : this.#document;
      return "shown";
    }
    const detached = this.#undoable;
    if (detached?.language !== language) return "new";
    if (this.workspace.current.text === detached.after) {
      this.undo();
      return "shown";
    }
    this.#isAsking = true;
    return "ask";
  }

  /**
   * Make the document a text: its picture leaves the file. The file with it is kept among the last programs.
   *
   * @param {(text: string) => string} withoutPicture
   */
  detach(withoutPicture) {
    const { workspace } = this;
    const { made } = this;
    const before = workspace.current.text;
    const after = withoutPicture(before);
    workspace.keep();
    workspace.replaceText(after);
    this.#detached = { document: this.#document, language: made, before, after };
    this.#asText = "";
    this.#isAsking = false;
  }

  /** Bring the picture back as it was; a text that has changed since is kept among the last programs. */
  undo() {
    const detached = this.#undoable;
    if (detached === null) return;
    if (this.workspace.current.text !== detached.after) this.workspace.keep();
    this.workspace.replaceText(detached.before);
    this.#detached = null;
    this.#isAsking = false;
  }

  /** Keep the text, and what was written since the picture left. */
  keepText() {
    this.#isAsking = false;
  }

  /** No longer offer to bring the picture back. */
  settle() {
    this.#detached = null;
  }

  /** Another document is opened. */
  forget() {
    this.#asText = "";
    this.#detached = null;
    this.#isAsking = false;
  }
}
