// An editing session of the creator: the model, the world drawn from it, and the drafts that the browser keeps. It
// outlives the panels, which are rebuilt when the language changes.

import { Markers } from "../playground/markers.js";
import { fileNameOf, write } from "../playground/document.js";
import { writeDraft } from "../playground/draft_text.js";
import { partsOf } from "../playground/parts.js";
import { Pictures } from "../playground/pictures.js";
import { worldOf } from "../playground/world.js";
import { CreatorModel } from "./creator_model.js";
import { newPlayground } from "./commands.js";
import { sketchOf } from "./sketch.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../playground_tab/drafts.js").Drafts} Drafts */
/**
 * Where the playground is kept: `fresh` nothing was changed yet, `device` this browser, `file` also a file, `none` it is
 * too large for the browser.
 *
 * @typedef {"fresh" | "device" | "file" | "none"} Kept
 */

const KEEP_AFTER_MS = 400;
const ASK_AFTER_MS = 100;
/** After a request without an answer. */
const ASK_AGAIN_AFTER_MS = 1000;

export class CreatorSession {
  /**
   * @param {object} options
   * @param {Drafts} options.drafts
   * @param {string} options.title      title of a new playground
   * @param {(phrase: Phrase) => void} options.report
   * @param {() => void} options.changed   requests a new frame
   * @param {(items: readonly import("../playground/parts.js").Item[]) => Promise<boolean>} options.learn   asks the simulator for
   *   exact parts; whether it has answered
   */
  constructor({ drafts, title, report, changed, learn }) {
    this.drafts = drafts;
    this.learn = learn;
    this.isAsking = false;
    this.onChange = changed;
    const first = this.#asDraft(newPlayground(title));
    this.model = new CreatorModel({ playground: first, report, changed: () => this.#changed() });
    this.pictures = new Pictures(() => {
      this.drawn = null;
      this.#changed();
    });
    this.markers = new Markers((uri) => this.pictures.get(uri));
    /** @type {Map<string, Playground>} as files have them, by draft */ this.saved = new Map();
    /** @type {WeakSet<Playground>} as they were opened: not kept before they are changed */ this.untouched = new WeakSet([first]);
    /** @type {Playground} as the browser has it, or as it was opened */ this.stored = first;
    this.isTooLarge = false;
    /** @type {{ of: Playground, as: Playground, same: boolean } | null} cache of the last comparison */ this.compared = null;
    this.timer = 0;
    /** @type {{ of: Playground["items"], dragged: string | undefined, world: State } | null} cache of the last drawn world */
    this.drawn = null;
    /** @type {import("./sketch.js").Sketch | null} */ this.sketched = null;
  }

  /** @returns {Kept} */
  get kept() {
    const { playground } = this.model;
    if (this.#isInFile(playground)) return "file";
    if (this.isTooLarge) return "none";
    return this.untouched.has(playground) ? "fresh" : "device";
  }

  /** The playground as the scene draws it, without the item being dragged. */
  get world() {
    const { playground, selecting } = this.model;
    const dragged = selecting.moving?.name;
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

  /** What is shown, with the item that is being placed. */
  get #items() {
    const { playground, ghost } = this.model;
    return ghost === null ? playground.items : [...playground.items, ghost.item];
  }

  /** Whether the simulator has answered for all that is shown. */
  get isKnown() {
    return this.#items.every((item) => partsOf(item).isKnown);
  }

  /** Call once per frame: asks the simulator for unknown parts of what is shown, a few times per second. */
  async ask() {
    if (this.isAsking || this.isKnown) return;
    this.isAsking = true;
    const hasAnswer = await this.learn(this.#items);
    const goOn = () => {
      this.isAsking = false;
      if (hasAnswer) this.onChange(); // what was changed meanwhile
    };
    setTimeout(goOn, hasAnswer ? ASK_AFTER_MS : ASK_AGAIN_AFTER_MS);
    if (!hasAnswer) return;
    this.drawn = null;
    this.#changed();
  }

  /** The playground as file content. */
  get text() {
    return write(this.model.playground);
  }

  get fileName() {
    return fileNameOf(this.model.playground.title);
  }

  noteSaved() {
    const { playground } = this.model;
    this.saved.set(playground.draft ?? "", playground);
    this.untouched.delete(playground);
    this.#store();
    this.#changed();
  }

  /**
   * Open another playground; undo restores the previous one. A draft is continued, anything else becomes a new draft as
   * soon as it is changed.
   *
   * @param {Playground} playground
   * @param {Phrase} change
   * @param {boolean} [inFile]   whether a file has it
   */
  replacePlayground(playground, change, inFile = false) {
    this.keep();
    const next = this.#asDraft(playground);
    if (inFile) this.saved.set(next.draft ?? "", next);
    if (playground.draft === undefined) this.untouched.add(next);
    this.model.selected = null;
    this.model.placing = null;
    this.stored = next;
    this.isTooLarge = false;
    this.model.replacePlayground(next, change);
  }

  /** Keep the playground in the browser now. */
  keep() {
    clearTimeout(this.timer);
    if (this.stored !== this.model.playground) this.#store();
  }

  /** @param {Playground} playground @returns {Playground} */
  #asDraft(playground) {
    return playground.draft === undefined ? { ...playground, draft: this.drafts.newId() } : playground;
  }

  /** Whether a file has the same content. @param {Playground} playground */
  #isInFile(playground) {
    const other = this.saved.get(playground.draft ?? "");
    if (other === undefined || playground === other) return playground === other;
    if (this.compared?.of !== playground || this.compared.as !== other) {
      this.compared = { of: playground, as: other, same: writeDraft(playground) === writeDraft(other) };
    }
    return this.compared.same;
  }

  #store() {
    const { playground } = this.model;
    const { draft: id = "", title } = playground;
    this.stored = playground;
    this.isTooLarge = false;
    if (this.untouched.has(playground) && !this.drafts.has(id)) return;
    try {
      this.drafts.keep({ id, title, inFile: this.#isInFile(playground), text: writeDraft(playground) });
    } catch {
      this.isTooLarge = true;
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
}
