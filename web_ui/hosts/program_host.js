// Integrates the tab "Program": loads it and the language of the document on demand, and forwards messages while it is
// shown.
//
// One document, several views. The document (an .aesl file with all its parts, its draft, which robot has it) belongs
// to the session, in `editor/workspace.js`; it outlives views. `program_tab/tab.js` has what all languages share: run,
// stop, files, badge, new programs. A language is a view of the open document, in a module of its own. The file decides
// which one: a picture or blocks in it belong to their language, every other file is text.

import { BLOCKS, looksLikeBlocks } from "../blockly/language.js";
import { followLocalStore, localStore } from "../browser/local_storage.js";
import { meetOtherTabs, openPages } from "../browser/other_tabs.js";
import { isPython } from "../browser/python_name.js";
import { textOf } from "../browser/text_file.js";
import { looksLikeToolbox } from "../editor/toolbox_file.js";
import { importerOf, languageOf, LanguageChoice, TEXT } from "../program_tab/language_choice.js";
import { CONNECTION } from "../state/index.js";
import { holdsVpl } from "../vpl/holds.js";

/** @typedef {import("../editor/editor_session.js").EditorSession} EditorSession */
/** @typedef {import("../program_tab/tab.js").ProgramTab} ProgramTab */
/** @typedef {import("../python/node_client.js").NodeClient} NodeClient */
/** @typedef {import("../shell/context.js").Context} Context */
/**
 * A language's view of the open document. It edits by `session.workspace.edit(code)` or, if the language owns more than
 * the text, `session.workspace.replaceText(text)`; it draws what the session holds. A teacher's file may hide blocks
 * (`session.toolbox`).
 *
 * @typedef {object} ProgramView
 * @property {HTMLElement} element            fills the tab below the head
 * @property {HTMLElement | null} bar         controls of the language, beside the badge
 * @property {readonly HTMLElement[]} entries   of the language, in the menu of the file
 * @property {() => void} show                another document is open, or the view is on the page for the first time
 * @property {() => void} resized             the tab is shown again: sizes were not known while it was hidden
 * @property {() => void} redraw              draw; called once per frame when something changed
 * @property {() => boolean} hasMistake       whether the program cannot run as it is
 * @property {() => void} showMistake         lead the user to the first mistake
 * @property {(text: string, kind: "good" | "warning" | "error") => void} report   what became of a command
 * @property {() => Promise<void>} loaded     the robot has the document now
 * @property {() => void} focus
 * @property {() => void} destroy
 * @property {Runner} [runner]                runs and stops the program, in place of the robot
 */
/**
 * @typedef {object} Runner
 * @property {() => Promise<void>} run
 * @property {() => void} stop
 * @property {() => boolean} isRunning
 * @property {() => string} reason    why it cannot run; "": it can
 */
/** @typedef {(parts: import("../program_tab/tab.js").Parts) => ProgramView} CreateView */
/** @typedef {import("../ui/icons.js").IconName} IconName */
/**
 * @typedef {object} LanguageModule
 * @property {CreateView} createView
 * @property {(name: string, t: import("../i18n/index.js").Translate) => string} sampleText   of one of its samples
 * @property {(text: string) => string} [withoutPicture]   the file as text: without the picture or the blocks
 * @property {(bytes: Uint8Array, language: string) => Promise<Imported>} [importFile]   a file of another program
 */
/** @typedef {import("../blockly/import.js").Imported} Imported */
/** @typedef {{ name: string, key: string, icon: IconName }} Sample   texts: `new.<key>` and `new.<key>.text` */
/**
 * @typedef {object} Language   its name is the text `language.<id>`, `language.<id>.text` says what it is
 * @property {string} id
 * @property {IconName} icon
 * @property {(text: string, name?: string) => boolean} holds    whether a file is a program of this language, cheaply;
 *   the first one that does counts
 * @property {string} [ending]                    of the names of its files; else .aesl
 * @property {readonly Sample[]} samples          programs to begin with
 * @property {readonly { name: string, key: string }[]} [more]   further samples, which have a title only
 * @property {readonly string[]} [imports]        endings of files of other programs, such as ".sb3"
 * @property {() => Promise<LanguageModule>} load
 * @property {() => Promise<readonly string[]>} [toolboxNames]   what a teacher's file can hide, and modes
 */

/** The language of ROS nodes in Python, which the suite runs. */
export const NODE = "ros";

/** The languages of programs, in display order. To add one: a line here. @type {readonly Language[]} */
export const LANGUAGES = [
  {
    id: "vpl",
    icon: "vpl",
    holds: holdsVpl,
    samples: [
      { name: "empty", key: "vpl_empty", icon: "file" },
      { name: "avoid", key: "vpl_avoid", icon: "beams" },
      { name: "line", key: "vpl_line", icon: "track" },
    ],
    more: ["buttons", "music", "timer", "states", "remote", "tilt", "counter"].map((name) => ({ name, key: `vpl_${name}` })),
    load: () => import("../vpl/view/index.js"),
    toolboxNames: async () => (await import("../vpl/toolbox.js")).NAMES,
  },
  BLOCKS,
  {
    id: TEXT,
    icon: "text",
    holds: (_text, name = "") => !isPython(name),
    samples: [
      { name: "button", key: "button", icon: "pad" },
      { name: "avoid", key: "avoid", icon: "beams" },
      { name: "line", key: "line", icon: "track" },
      { name: "empty", key: "empty", icon: "file" },
    ],
    load: () => import("../editor/index.js"),
  },
  {
    id: NODE,
    icon: "plug",
    ending: ".py",
    holds: (_text, name = "") => isPython(name),
    samples: [
      { name: "first", key: "ros_first", icon: "beams" },
      { name: "empty", key: "ros_empty", icon: "file" },
    ],
    load: () => import("../python/index.js"),
  },
];

/** Languages of missions that are a look of another one: its editor, and its empty sample. @type {Readonly<Record<string, { id: string, sample: string }>>} */
const EDITORS = { scratch: { id: BLOCKS.id, sample: "scratch_start" } };

/**
 * The editors of the languages of a mission.
 *
 * @param {readonly string[] | null} languages   null: all
 * @returns {readonly string[] | null}
 */
export function editorsOf(languages) {
  return languages?.map((language) => EDITORS[language]?.id ?? language) ?? null;
}

/** Time without a further change until a text that was written is sent to the class. */
const DRAFT_MS = 1000;
const TOPIC = /^\/(?:[^/]+\/)?_aseba\/(?:target|variables|events)$|^\/aseba_runtime\/_behaviours$/;

export class ProgramHost {
  /** @type {typeof import("../program_tab/tab.js") | null} */ #module = null;
  /** The language whose view is wanted: loading it takes a while. */ #wanted = "";
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #draftTimer = undefined;
  #draftName = "";
  /** Done when it is known what the page may do with nodes. */ #learned = Promise.resolve();
  /** @type {{ name: string, text: string } | null} opened when the tab is shown */ #kept = null;

  /**
   * @param {object} options
   * @param {HTMLElement} options.slot   the panel of the tab
   * @param {() => import("../protocol/client.js").Client} options.client
   * @param {string} [options.token]
   */
  constructor({ slot, client, token = "" }) {
    this.slot = slot;
    this.client = client;
    this.token = token;
    /** @type {NodeClient | null} the nodes of this page, once the tab is loaded */ this.node = null;
    /** Whether the tab is shown. */
    this.isOpen = false;
    /** @type {EditorSession | null} */ this.session = null;
    /** @type {LanguageChoice | null} */ this.choice = null;
    /** @type {ProgramTab | null} stays alive while other tabs are shown */ this.tab = null;
    /** @type {Context | null} */ this.context = null;
    /** Called with the name of the document and its text when the user has written. @type {(name: string, text: string) => void} */
    this.onWritten = () => {};
  }

  /** Whether the tab currently needs a topic: not before it is loaded, as a message would be lost. @param {string} topic */
  wants(topic) {
    return this.isOpen && this.session !== null && TOPIC.test(topic);
  }

  /** @param {import("../protocol/client.js").ClientEvent} event @param {string} selected  robot */
  receive(event, selected) {
    if (this.session === null || (event.type !== "message" && event.type !== "disconnected")) return;
    this.session.receive(event, selected);
    this.redraw();
  }

  redraw() {
    if (this.isOpen) this.tab?.redraw();
  }

  /** Set the context: on start, and after a change of language. @param {Context} context */
  setContext(context) {
    this.context = context;
    if (this.tab !== null) this.#build();
  }

  /** Show or hide the tab: call when it is opened or left. @param {boolean} visible */
  async setVisible(visible) {
    if (visible === this.isOpen) return;
    this.isOpen = visible;
    this.tab?.setShown(visible);
    if (visible) await this.#opened();
    this.client().refresh();
  }

  /** The program that the tab has open, with its language; null if the tab cannot be loaded. */
  async openProgram() {
    if (!(await this.#load()) || this.session === null) return null;
    const { name, text } = this.session.workspace.current;
    return { text, language: languageOf({ name, text }, LANGUAGES) };
  }

  /** Open the tab with a program. @param {string} name @param {string} text */
  async openText(name, text) {
    (await this.#selected())?.commands.openText(name, text);
  }

  /** Open the tab with a program from elsewhere, beside what the user has. @param {string} name @param {string} text */
  async openBeside(name, text) {
    (await this.#selected())?.commands.openBeside(name, text);
  }

  /**
   * Open the tab with a program that is kept elsewhere, such as that of a mission, or with an empty one. Returns the name
   * of its document; "": it could not be opened.
   *
   * @param {string} language   one of a mission
   * @param {string} title
   * @param {string | null} text   null: empty
   * @param {import("../editor/toolbox_file.js").Toolbox | null} [toolbox]   blocks that are hidden until `limit(null)`
   */
  async openAs(language, title, text, toolbox = null) {
    const { id, sample } = EDITORS[language] ?? { id: language, sample: undefined };
    const editor = LANGUAGES.find((each) => each.id === id);
    const tab = await this.#selected();
    if (editor === undefined || tab === null) return "";
    this.limit(toolbox);
    return tab.commands.openAs(editor, title, text, sample);
  }

  /** Hide blocks while a mission is open; null: as the user has chosen. @param {import("../editor/toolbox_file.js").Toolbox | null} toolbox */
  limit(toolbox) {
    this.session?.limit(toolbox);
    this.redraw();
  }

  /** The text of the open program; "": none is open. */
  get text() {
    return this.session?.workspace.current.text ?? "";
  }

  /** Open the tab with a program file. @param {File} file */
  async openFile(file) {
    void (await this.#selected())?.commands.open(file);
  }

  /** Have a program opened the next time that the tab is shown. @param {string} name @param {string} text */
  async keepText(name, text) {
    if (this.isOpen) return this.openText(name, text);
    this.#kept = { name, text };
  }

  /** Open the tab with the ways to begin: skeletons, examples, the last programs. */
  async openStart() {
    (await this.#selected())?.commands.newFile();
  }

  /**
   * Open a file that was dropped while the tab is shown and that may belong to another part of the page: a teacher's
   * list of blocks, or a program of another program. Returns whether it was one.
   *
   * @param {File} file
   */
  async openOther(file) {
    if (!this.isOpen) return false;
    if (importerOf(file, LANGUAGES) !== null) {
      if (/\.xml$/i.test(file.name) && !looksLikeBlocks(new Uint8Array(await file.arrayBuffer()))) return false;
      await this.openFile(file);
      return true;
    }
    if (!/\.json$/i.test(file.name)) return false;
    const text = await textOf(file);
    if (text === null || !looksLikeToolbox(text)) return false;
    await this.tab?.commands.openToolbox(file.name, text);
    return true;
  }

  async #selected() {
    this.context?.workspace.select("program");
    return this.#opened();
  }

  /** The tab; null if it cannot be loaded. @returns {Promise<ProgramTab | null>} */
  async #opened() {
    if (!(await this.#load())) return null;
    if (this.tab === null) this.#build();
    if (this.#kept !== null) this.tab?.commands.openText(this.#kept.name, this.#kept.text);
    this.#kept = null;
    return this.tab;
  }

  /** Load the tab; returns whether it is there. */
  async #load() {
    const module = await this.#imported(() => import("../program_tab/tab.js"));
    if (module === null) return false;
    this.#module ??= module;
    if (this.session === null) {
      const session = new module.EditorSession(localStore, Date.now, openPages(navigator.locks));
      this.session = session;
      session.onWritten = (text) => {
        const { name } = session.workspace.current;
        this.#sendDraft(name, text);
        this.onWritten(name, text);
      };
      followLocalStore((key) => session.workspace.storageChanged(key));
      meetOtherTabs(() => {
        const { store, text } = /** @type {Context} */ (this.context);
        store.dispatch({ type: "notice", level: "warning", text: text("program")("program.otherTab") });
      });
    }
    this.node ??= this.#newNode(module);
    this.choice ??= new LanguageChoice({ workspace: this.session.workspace, languages: LANGUAGES });
    return true;
  }

  /** @param {typeof import("../program_tab/tab.js")} module */
  #newNode({ NodeClient }) {
    const node = new NodeClient({ page: location.href, token: this.token, changed: () => this.redraw() });
    const { actions } = /** @type {Context} */ (this.context);
    actions.node = node;
    this.#learned = node.learn();
    return node;
  }

  /** Whether the page may run nodes; loads the tab. */
  async mayRunNodes() {
    if (!(await this.#load())) return false;
    await this.#learned;
    return this.node?.mayRun ?? false;
  }

  /** Run the open program. */
  async run() {
    await (await this.#opened())?.commands.run();
  }

  /** @param {string} name @param {string} text */
  #sendDraft(name, text) {
    if (name === this.#draftName) clearTimeout(this.#draftTimer); // the text of another document is still sent
    this.#draftName = name;
    this.#draftTimer = setTimeout(() => void this.context?.actions.sendDraft(name, text), DRAFT_MS);
  }

  /**
   * A module that is loaded now; null if there is no connection.
   *
   * @template T
   * @param {() => Promise<T>} load
   * @returns {Promise<T | null>}
   */
  async #imported(load) {
    try {
      return await load();
    } catch {
      const { store, text } = /** @type {Context} */ (this.context);
      store.dispatch({ type: "notice", level: "error", text: text("page")("app.notLoaded"), cause: CONNECTION });
      return null;
    }
  }

  #build() {
    if (this.#module === null || this.session === null || this.choice === null || this.context === null) return;
    if (this.node === null) return;
    this.tab?.destroy();
    this.tab = new this.#module.ProgramTab({
      session: this.session,
      choice: this.choice,
      node: this.node,
      context: this.context,
      languages: LANGUAGES,
      load: (language) => this.#imported(language.load),
      show: (id) => void this.#show(id),
    });
    this.slot.append(this.tab.element);
    this.tab.setShown(this.isOpen);
    void this.#show(this.choice.shown);
  }

  /** Show the document in a language. @param {string} id */
  async #show(id) {
    this.#wanted = id;
    const { tab } = this;
    const language = LANGUAGES.find((each) => each.id === id);
    if (language === undefined) return;
    const module = await this.#imported(language.load);
    if (module !== null && this.#wanted === id && this.tab === tab) tab?.setView(id, module.createView);
  }
}
