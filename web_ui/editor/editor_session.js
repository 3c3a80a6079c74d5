// State of the editor that outlives a change of language or closing the editor: programs, robot data, watched
// variables.

import { trySetItem } from "../browser/local_storage.js";
import { FileStore } from "./file_store.js";
import { History } from "./history.js";
import { INITIAL, reduce } from "./state.js";
import { readToolbox, WHOLE, writeToolbox } from "./toolbox_file.js";
import { Workspace } from "./workspace.js";

const WATCHED_KEY = "editor.watched";
const SIZE_KEY = "editor.fontSize";
const TOOLBOX_KEY = "program.toolbox";
const SIZES = [10, 11, 12, 13, 14, 16, 18, 20, 24, 28, 32]; // pixels

export class EditorSession {
  /**
   * @param {import("../browser/local_storage.js").KeyValueStore} storage
   * @param {() => number} now
   * @param {import("../browser/other_tabs.js").OpenPages} [pages]
   */
  constructor(storage, now, pages) {
    this.storage = storage;
    this.state = INITIAL;
    this.history = new History();
    this.tool = "values";
    /** Whether the user is choosing how to begin a new program. */
    this.isChoosing = false;
    /** Whether the values of all variables are listed. */
    this.isAllListed = false;
    /** @type {Map<string, any>} editor state of each text: cursor and undo history */ this.texts = new Map();
    /** @type {() => void} */ this.onText = () => {};
    /** @type {(text: string) => void} */ this.onWritten = () => {};
    /** @type {() => void} */ this.onOffer = () => {};
    this.workspace = new Workspace({
      fileStore: new FileStore(storage, pages),
      now,
      changed: () => this.onText(),
      written: (text) => this.onWritten(text),
      offered: () => this.onOffer(),
    });
    /** @type {Set<string>} */ this.watched = new Set(JSON.parse(storage.getItem(WATCHED_KEY) ?? "[]"));
    /** @type {import("./toolbox_file.js").Toolbox} what a teacher's file hides */
    this.toolbox = this.#keptToolbox();
    /** @type {import("../blockly/view/document.js").KeptBlocks | null} of the last view of blocks */
    this.blocks = null;
    /** @type {{ text: string, leftOut: readonly string[] } | null} the last file of another program */
    this.imported = null;
    this.fontSize = Number(storage.getItem(SIZE_KEY)) || 14;
  }

  /** @param {import("./state.js").Message} message @param {string} selected  the robot whose values are plotted */
  receive(message, selected) {
    const before = this.state;
    this.state = reduce(before, message);
    if (message.type !== "message") return;
    const seconds = Number(message.timeNs) / 1e9;
    const now = this.state.variables[selected];
    if (now !== undefined && now !== before.variables[selected]) {
      for (const name of this.watched) {
        const values = now.values.get(name) ?? [];
        values.forEach((value, index) =>
          this.history.add(values.length === 1 ? name : `${name}[${index}]`, seconds, value),
        );
      }
    }
    const event = this.state.log.at(-1);
    if (event === undefined || event === before.log.at(-1) || event.robot !== selected) return;
    if (!this.watched.has(eventKey(event.name))) return;
    const values = event.values.length === 0 ? [0] : event.values;
    values.forEach((value, index) => this.history.add(`${event.name}(${index})`, seconds, value));
  }

  /** @param {string} key  a variable, or `eventKey` of an event */
  toggleWatch(key) {
    if (!this.watched.delete(key)) this.watched.add(key);
    trySetItem(this.storage, WATCHED_KEY, JSON.stringify([...this.watched]));
    for (const name of [...this.history.series.keys()]) {
      const owner = name.endsWith(")") ? eventKey(name.replace(/\(\d+\)$/, "")) : name.replace(/\[\d+\]$/, "");
      if (!this.watched.has(owner)) this.history.series.delete(name);
    }
  }

  /**
   * Limit the blocks, in this browser, until that is taken back.
   *
   * @param {import("./toolbox_file.js").Toolbox} toolbox
   */
  setToolbox(toolbox) {
    this.toolbox = toolbox;
    if (toolbox === WHOLE) this.storage.removeItem(TOOLBOX_KEY);
    else trySetItem(this.storage, TOOLBOX_KEY, writeToolbox(toolbox));
  }

  #keptToolbox() {
    return readToolbox(this.storage.getItem(TOOLBOX_KEY) ?? "").toolbox ?? WHOLE;
  }

  /** Limit the blocks for a while, as a mission does; null: as this browser has them. @param {import("./toolbox_file.js").Toolbox | null} toolbox */
  limit(toolbox) {
    this.toolbox = toolbox ?? this.#keptToolbox();
  }

  /** @param {number} step  +1 or -1 */
  resize(step) {
    const index = SIZES.findIndex((size) => size >= this.fontSize);
    this.fontSize = SIZES[Math.min(Math.max(index + step, 0), SIZES.length - 1)];
    trySetItem(this.storage, SIZE_KEY, String(this.fontSize));
  }
}

/** The key under which an event is watched; no variable has such a name. @param {string} name */
export function eventKey(name) {
  return `event ${name}`;
}
