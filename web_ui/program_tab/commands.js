// What the user does with programs and robots: begin, open, save, load, run and control. All languages share it.

import { download } from "../browser/download.js";
import { kindOf, sentenceOf } from "../browser/foreign_files.js";
import { isPython } from "../browser/python_name.js";
import { textOf } from "../browser/text_file.js";
import { looksLikeToolbox, readToolbox, unknownNames, WHOLE } from "../editor/toolbox_file.js";
import { isExample } from "../examples/index.js";
import { LARGEST_PROGRAM } from "../input/actions.js";
import { robotTopic } from "../state/names.js";
import { importerOf } from "./language_choice.js";

/** Kinds of files that become programs of blocks, whatever their name is, and a name with their ending. */
const BLOCKS = ["scratch", "blocks"];
const IMPORTED = "blocks.sb3";
/** Projects of other programs hold pictures and sounds, too. */
const LARGEST_IMPORT = 20_000_000;

/** @typedef {import("../hosts/program_host.js").Language} Language */
/** @typedef {import("../hosts/program_host.js").LanguageModule} LanguageModule */
/** @typedef {import("../input/runtime_client.js").Verb} Verb */

/** Samples without anything in them, by their names. */
const EMPTY = ["empty", "scratch_start"];

/**
 * What a program is called that begins with a sample.
 *
 * @param {import("../hosts/program_host.js").Language} language
 * @param {string} name  of the sample
 * @param {import("../i18n/index.js").Translate} t
 */
function titleOfSample({ samples, more = [] }, name, t) {
  const { key } = [...samples, ...more].find((sample) => sample.name === name) ?? { key: "own" };
  return EMPTY.includes(name) ? t("new.own") : t(`new.${key}`).split(":")[0].trim();
}

export class ProgramCommands {
  /**
   * @param {object} options
   * @param {import("../i18n/index.js").Translate} options.t
   * @param {import("../i18n/index.js").Translate} options.pageText
   * @param {string} options.language
   * @param {import("../editor/editor_session.js").EditorSession} options.session
   * @param {import("./language_choice.js").LanguageChoice} options.choice
   * @param {readonly import("../hosts/program_host.js").Language[]} options.languages
   * @param {(language: Language) => Promise<LanguageModule | null>} options.load
   * @param {import("../input/actions.js").Actions} options.actions
   * @param {import("../editor/robot_selection.js").RobotSelection} options.selection
   * @param {() => import("../hosts/program_host.js").ProgramView | null} options.view  of the chosen language
   * @param {(text: string, kind: "good" | "warning" | "error") => void} options.report
   * @param {() => void} options.redraw
   */
  constructor(options) {
    const { t, pageText, language, session, choice, languages, load, actions, selection, view, report, redraw } = options;
    this.t = t;
    this.pageText = pageText;
    this.language = language;
    this.session = session;
    this.choice = choice;
    this.languages = languages;
    this.loadLanguage = load;
    this.workspace = session.workspace;
    this.actions = actions;
    this.runtime = actions.runtime;
    this.selection = selection;
    this.view = view;
    this.report = report;
    this.redraw = redraw;
  }

  /** Show the ways to begin a program; the open one stays until one of them is chosen. */
  newFile() {
    this.session.isChoosing = true;
    this.redraw();
  }

  /** Return to the open program. */
  back() {
    this.session.isChoosing = false;
    this.redraw();
    this.view()?.focus();
  }

  /**
   * Begin with a program of a language.
   *
   * @param {import("../hosts/program_host.js").Language} language
   * @param {string} name  of one of its samples
   */
  async begin(language, name) {
    const module = await this.loadLanguage(language);
    if (module === null) return;
    const text = module.sampleText(name, this.t);
    this.choice.forget();
    this.workspace.begin(titleOfSample(language, name, this.t) + (language.ending ?? ""), text);
    this.back();
  }

  /**
   * Open a program that is kept elsewhere, or an empty one of a language. Returns the name of its document; "": it could
   * not be opened.
   *
   * @param {import("../hosts/program_host.js").Language} language
   * @param {string} title
   * @param {string | null} text   null: empty
   * @param {string} [sample]   the empty sample
   */
  async openAs(language, title, text, sample = EMPTY[0]) {
    const module = text === null ? await this.loadLanguage(language) : null;
    if (text === null && module === null) return "";
    this.choice.forget();
    this.workspace.show(title + (language.ending ?? ""), text ?? module?.sampleText(sample, this.t) ?? "");
    this.back();
    return this.workspace.current.name;
  }

  /** Begin with a program that was made from the open one, which is kept among the last programs. @param {string} text */
  beginFromThis(text) {
    const { name } = this.workspace.current;
    this.workspace.keep();
    this.choice.forget();
    this.workspace.begin(name, text);
    this.back();
  }

  /** Make the document a text: its picture or blocks leave the file. */
  async detach() {
    const language = this.languages.find(({ id }) => id === this.choice.made);
    const module = language === undefined ? null : await this.loadLanguage(language);
    if (!module?.withoutPicture) return;
    this.choice.detach(module.withoutPicture);
    this.session.onText();
    this.view()?.focus();
  }

  /** Limit the blocks by a teacher's file. @param {string} name @param {string} content */
  async openToolbox(name, content) {
    const { t } = this;
    const { toolbox, problem } = readToolbox(content);
    if (toolbox === null) return this.report(`${name}: ${t(problem.key, problem.values)}`, "error");
    const known = await Promise.all(this.languages.map((language) => language.toolboxNames?.() ?? []));
    const unknown = unknownNames(toolbox, known.flat());
    this.session.setToolbox(toolbox);
    this.redraw();
    if (unknown.length > 0) return this.report(t("toolbox.unknown", { found: unknown.join(", ") }), "warning");
    this.report(t("toolbox.used", { name }), "good");
  }

  /** Show all blocks again. */
  showAllBlocks() {
    this.session.setToolbox(WHOLE);
    this.redraw();
    this.report(this.t("toolbox.all"), "good");
  }

  /** Endings of files of other programs. */
  get imports() {
    return this.languages.flatMap(({ imports = [] }) => imports);
  }

  /** @param {File} chosen */
  async open(chosen) {
    const { name, size } = chosen;
    const kind = size > LARGEST_IMPORT ? "" : kindOf(new Uint8Array(await chosen.arrayBuffer()));
    const importer = importerOf(BLOCKS.includes(kind) ? { name: IMPORTED } : chosen, this.languages);
    if (importer !== null && ["", ...BLOCKS].includes(kind)) return this.#import(chosen, importer);
    const isNode = isPython(name) && ["ros", "python"].includes(kind);
    if (!["", "program", "json"].includes(kind) && !isNode) {
      return this.report(`${name}: ${sentenceOf(kind, this.language)}`, "error");
    }
    if (size > LARGEST_PROGRAM) return this.report(this.t("editor.tooLarge", { name }), "error");
    const content = await textOf(chosen);
    if (content === null) return this.report(this.pageText("file.notText", { name: chosen.name }), "error");
    if (looksLikeToolbox(content)) return this.openToolbox(chosen.name, content);
    if (kind === "json") return this.report(`${name}: ${sentenceOf(kind, this.language)}`, "error");
    this.openText(chosen.name, content);
  }

  /**
   * Open a file of another program.
   *
   * @param {File} chosen
   * @param {import("../hosts/program_host.js").Language} language
   */
  async #import(chosen, language) {
    const { name } = chosen;
    if (chosen.size > LARGEST_IMPORT) return this.report(this.t("editor.tooLarge", { name }), "error");
    const module = await this.loadLanguage(language);
    if (!module?.importFile) return;
    const bytes = new Uint8Array(await chosen.arrayBuffer());
    const { text, problem, leftOut } = await module.importFile(bytes, this.language);
    if (problem !== "") {
      this.report(`${name}: ${problem}`, "error");
      return this.back();
    }
    this.session.imported = { text, leftOut };
    this.openText(name.replace(/\.\w+$/, ""), text);
    if (leftOut.length > 0) this.report(this.t("import.leftOut", { name, count: leftOut.length }), "warning");
  }

  /** @param {string} name @param {string} content */
  openText(name, content) {
    this.choice.forget();
    const refusal = this.workspace.open(name, content);
    if (refusal !== null) this.report(this.t("editor.refused", { ...refusal }), "error");
    this.back();
  }

  /** Open a program from elsewhere; what the user has stays. @param {string} name @param {string} content */
  openBeside(name, content) {
    const { name: present } = this.workspace.current;
    const isBuiltIn = this.session.state.behaviors.some((behavior) => isExample(present, behavior.name));
    this.choice.forget();
    const refusal = this.workspace.openBeside(name, content, isBuiltIn);
    if (refusal !== null) this.report(this.t("editor.refused", { ...refusal }), "error");
    this.back();
  }

  /** Open one of the last programs. @param {import("../editor/file_store.js").StoredFile} recent */
  openRecent(recent) {
    if (!recent.unsaved) return this.openText(recent.name, recent.text);
    this.choice.forget();
    this.workspace.restore(recent);
    this.back();
  }

  /** Start a built-in behavior on the robots, and show it. @param {string} name */
  async openExample(name) {
    const { ok } = await this.actions.loadExample(name); // which reports a failure
    if (!ok) return;
    this.workspace.follow(); // only now: until then the robot has another program
    this.back();
  }

  save() {
    const { name, text } = this.workspace.current;
    download(name, text, isPython(name) ? "text/x-python" : "application/xml");
    this.workspace.saved();
    this.redraw();
  }

  /** Load the program into the robots that it is for, where it starts, and report the result. Returns whether it did. */
  async load() {
    const { tab } = this.workspace;
    const { name, text: source } = this.workspace.current;
    const { ok, message, fault, notes } = await this.actions.load(name, source);
    if (!ok) {
      this.#reportRejection(message, fault);
      return false;
    }
    this.workspace.loaded(tab, source);
    this.report(this.t("editor.loaded", { name }), "good");
    if (notes.length > 0) this.report(`${this.t("editor.loaded", { name })}: ${notes.join("; ")}`, "warning");
    if (this.workspace.tab === tab) await this.view()?.loaded();
    this.redraw();
    return true;
  }

  /** Load the program, and let it wait in its first line. */
  async put() {
    if (this.#isBlocked() || !(await this.load())) return;
    await this.control("reset");
    this.report(this.t("editor.put", { name: this.workspace.current.name }), "good");
  }

  /** @param {string} message  of the runtime @param {import("../input/check_service.js").Fault | null} fault */
  #reportRejection(message, fault) {
    const line = fault?.line ?? null;
    const place = line === null ? null : this.workspace.codeLine(line);
    this.report(place === null ? message : this.t("check.error", { line: place, message }), "error");
  }

  /** Run the program from its beginning; it is loaded if the robots have another one. */
  async run() {
    if (this.#isBlocked()) return;
    const runner = this.view()?.runner;
    if (runner !== undefined) return runner.reason() === "" ? runner.run() : undefined;
    if (!this.workspace.isInRobot) return void (await this.load());
    const robots = this.selection.controlled;
    await Promise.all(robots.map((name) => this.runtime.control(name, "reset"))); // refused by one that is off
    await this.control("run");
  }

  /** Go on from where the program is halted; else run it. */
  async goOn() {
    if (this.view()?.runner !== undefined) return this.run();
    const isHalted = this.workspace.isInRobot && this.selection.status?.state === "paused";
    await (isHalted ? this.control("run") : this.run());
  }

  /** Whether the program has a mistake, which is then shown. */
  #isBlocked() {
    const view = this.view();
    if (view === null || !view.hasMistake()) return false;
    view.showMistake();
    return true;
  }

  /** @param {Verb} verb */
  async control(verb) {
    const runner = this.view()?.runner;
    if (runner !== undefined) return verb === "stop" ? runner.stop() : undefined;
    const answers = await Promise.all(this.selection.controlled.map((name) => this.runtime.control(name, verb)));
    if (answers.some(({ ok }) => !ok)) this.report(this.t("editor.notNow"), "error");
  }

  /** Whether a robot of the tab offers this service. @param {Verb} verb */
  can(verb) {
    const runner = this.view()?.runner;
    if (runner !== undefined) return verb === "stop" && runner.isRunning();
    const { services } = this.selection.store.state;
    return this.selection.controlled.some((name) => services.includes(robotTopic(name, `aseba/${verb}`)));
  }
}
