// What the user does with files and robots: open, save, load, run and control.

import { openSearchPanel } from "@codemirror/search";

import { textOf } from "../browser/text_file.js";
import { LARGEST_PROGRAM } from "../input/actions.js";
import { locate } from "../state/index.js";
import { robotTopic } from "../state/names.js";
import { readAesl } from "./aesl.js";
import { download } from "./download.js";

const THYMIO = "thymio-II";

/** @typedef {import("../input/runtime_client.js").Verb} Verb */

export class EditorCommands {
  /**
   * @param {object} options
   * @param {import("../i18n/index.js").Translate} options.t
   * @param {import("../i18n/index.js").Translate} options.pageText
   * @param {string} options.language
   * @param {import("./editor_session.js").EditorSession} options.session
   * @param {import("../input/actions.js").Actions} options.actions
   * @param {import("./robot_selection.js").RobotSelection} options.selection
   * @param {import("@codemirror/view").EditorView} options.view
   * @param {import("./debug_markers.js").DebugMarkers} options.markers
   * @param {(text: string, kind: "good" | "warning" | "error") => void} options.report
   * @param {() => void} options.redraw
   */
  constructor({ t, pageText, language, session, actions, selection, view, markers, report, redraw }) {
    this.t = t;
    this.pageText = pageText;
    this.language = language;
    this.session = session;
    this.workspace = session.workspace;
    this.actions = actions;
    this.runtime = actions.runtime;
    this.selection = selection;
    this.view = view;
    this.markers = markers;
    this.report = report;
    this.redraw = redraw;
  }

  newFile() {
    this.workspace.newFile();
  }

  /** @param {File} chosen */
  async open(chosen) {
    if (chosen.size > LARGEST_PROGRAM) return this.report(this.t("editor.tooLarge", { name: chosen.name }), "error");
    const content = await textOf(chosen);
    if (content === null) return this.report(this.pageText("file.notText", { name: chosen.name }), "error");
    this.openText(chosen.name, content);
  }

  /** @param {string} name @param {string} content */
  openText(name, content) {
    const refusal = this.workspace.open(name, content);
    if (refusal !== null) this.report(this.t("editor.refused", { ...refusal }), "error");
    this.view.focus();
  }

  /** Open an entry of the list of recent files and examples. @param {import("./toolbar.js").Choice} choice */
  async choose(choice) {
    if ("recent" in choice) {
      const { recent } = choice;
      if (!recent.unsaved) return this.openText(recent.name, recent.text);
      this.workspace.restore(recent);
      return this.view.focus();
    }
    this.workspace.follow();
    const { ok, message } = await this.actions.loadExample(choice.sample);
    if (!ok) this.report(message, "error");
  }

  save() {
    const { name, text } = this.workspace.current;
    download(name, text, "application/xml");
    this.workspace.saved();
    this.redraw();
  }

  /** Load the text into the robots of the tab, and report the result. */
  async load() {
    const { tab } = this.workspace;
    const { name, text: source } = this.workspace.current;
    const { ok, message } = await this.actions.load(name, source);
    if (!ok) return this.#reportRejection(name, source, message);
    this.workspace.loaded(tab, source);
    this.report(this.t("editor.loaded", { name }), "good");
    if (readAesl(source).nodes.some((node) => node.name !== THYMIO)) {
      const notes = await this.runtime.notes(source, this.language);
      if (notes.length > 0) this.report(`${this.t("editor.loaded", { name })}: ${notes.join("; ")}`, "warning");
    }
    // Send the current breakpoints: one may have been set while the request was in progress.
    if (this.workspace.tab === tab && this.markers.lines.length > 0) await this.markers.send();
    this.redraw();
  }

  /** @param {string} name @param {string} source @param {string} message  of the runtime */
  async #reportRejection(name, source, message) {
    const { text, line } = (await this.runtime.fault(source, this.language)) ?? locate(message, name);
    const place = line === null ? null : this.workspace.codeLine(line);
    this.report(place === null ? text : this.t("check.error", { line: place, message: text }), "error");
  }

  /** Run the robot's program if it is the shown text; else load the text. */
  async run() {
    await (this.workspace.isInRobot ? this.control("run") : this.load());
  }

  /** @param {Verb} verb */
  async control(verb) {
    const answers = await Promise.all(this.selection.controlled.map((name) => this.runtime.control(name, verb)));
    const refused = answers.find(({ ok }) => !ok);
    if (refused !== undefined) this.report(refused.message, "error");
  }

  /** Whether a robot of the tab offers this service. @param {Verb} verb */
  can(verb) {
    const { services } = this.selection.store.state;
    return this.selection.controlled.some((name) => services.includes(robotTopic(name, `aseba/${verb}`)));
  }

  /** @param {number} step  +1 or -1 */
  resize(step) {
    this.session.resize(step);
    this.redraw();
  }

  find() {
    openSearchPanel(this.view);
  }
}
