// An editing session of the creator: the model, the world drawn from it, and the draft that the browser stores.
// It outlives the panels, which are rebuilt when the language changes.

import { Markers } from "../playground/markers.js";
import { parse, write } from "../playground/document.js";
import { Pictures } from "../playground/pictures.js";
import { worldOf } from "../playground/world.js";
import { CreatorModel } from "./creator_model.js";
import { newPlayground } from "./commands.js";
import { sketchOf } from "./sketch.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../browser/local_storage.js").KeyValueStore} KeyValueStore */

const DRAFT_KEY = "creator.draft";
/** Whether the draft has been saved as a file. */
const SAVED_KEY = "creator.draftSaved";
const KEEP_AFTER_MS = 400;

export class CreatorSession {
  /**
   * @param {object} options
   * @param {KeyValueStore} options.storage
   * @param {string} options.title      title of a new playground
   * @param {(phrase: Phrase) => void} options.report
   * @param {() => void} options.changed   requests a new frame
   */
  constructor({ storage, title, report, changed }) {
    this.storage = storage;
    this.onChange = changed;
    const draft = this.#draft();
    this.model = new CreatorModel({ playground: draft ?? newPlayground(title), report, changed: () => this.#changed() });
    this.pictures = new Pictures(() => {
      this.drawn = null;
      this.#changed();
    });
    this.markers = new Markers((uri) => this.pictures.get(uri));
    const isSaved = draft === null || storage.getItem(SAVED_KEY) === "true";
    /** @type {Playground | null} as last saved */ this.saved = isSaved ? this.model.playground : null;
    this.stored = this.model.playground;
    /** @type {{ of: Playground, as: Playground, same: boolean } | null} cache of the last comparison */ this.compared = null;
    this.timer = 0;
    /** @type {{ of: Playground["items"], dragged: string | undefined, world: State } | null} cache of the last drawn world */
    this.drawn = null;
    /** @type {import("./sketch.js").Sketch | null} */ this.sketched = null;
  }

  /** Whether there are changes that no file contains. */
  get isUnsaved() {
    const { saved } = this;
    const { playground } = this.model;
    if (saved === null || playground === saved) return saved === null;
    if (this.compared?.of !== playground || this.compared.as !== saved) {
      this.compared = { of: playground, as: saved, same: write(playground) === write(saved) };
    }
    return !this.compared.same;
  }

  /** The playground as the scene draws it, without the item being dragged. */
  get world() {
    const { playground, selecting } = this.model;
    const dragged = selecting.ghost?.item.name;
    const { items } = playground;
    if (this.drawn === null || this.drawn.of !== items || this.drawn.dragged !== dragged) {
      const seen = dragged === undefined ? items : items.filter(({ name }) => name !== dragged);
      this.drawn = { of: items, dragged, world: worldOf(seen, this.markers) };
    }
    return this.drawn.world; // unchanged while only the pointer moves
  }

  get sketch() {
    this.sketched ??= sketchOf(this.model);
    return this.sketched;
  }

  /** The playground as file content. */
  get text() {
    return write(this.model.playground);
  }

  /** The file name: letters and digits of the title. */
  get fileName() {
    const stem = this.model.playground.title
      .normalize("NFKD")
      .replace(/\p{M}/gu, "")
      .replace(/[^\w]+/g, "_")
      .replace(/^_+|_+$/g, "");
    return `${stem.slice(0, 60) || "playground"}.json`;
  }

  noteSaved() {
    this.saved = this.model.playground;
    this.#store();
    this.#changed();
  }

  /**
   * Open another playground; undo restores the previous one.
   *
   * @param {Playground} playground
   * @param {Phrase} change
   */
  replacePlayground(playground, change) {
    this.model.selected = null;
    this.model.placing = null;
    this.model.replacePlayground(playground, change);
    this.saved = playground;
    this.#changed();
  }

  /** Store the draft in the browser now. */
  keep() {
    clearTimeout(this.timer);
    if (this.stored === this.model.playground) return;
    this.#store();
  }

  #store() {
    this.stored = this.model.playground;
    try {
      this.storage.setItem(DRAFT_KEY, this.text);
      this.storage.setItem(SAVED_KEY, String(!this.isUnsaved));
    } catch {
      this.storage.removeItem(DRAFT_KEY); // too large: no draft is better than an outdated one
      this.model.report({ word: "status.noDraft" });
    }
  }

  #changed() {
    this.sketched = null;
    if (this.model.playground !== this.stored) {
      clearTimeout(this.timer);
      this.timer = Number(setTimeout(() => this.keep(), KEEP_AFTER_MS));
    }
    this.onChange();
  }

  /** @returns {Playground | null} */
  #draft() {
    try {
      return parse(this.storage.getItem(DRAFT_KEY) ?? "");
    } catch {
      return null; // no draft, or one of another version
    }
  }
}
