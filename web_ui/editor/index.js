// The editor: creates the objects of one session and language, and draws them once per frame when something changed.
//
//   RobotSelection   which robots the text is for
//   ProgramChecker   the compiler's verdict on the text, and its repair
//   DebugMarkers     breakpoints and the line at which the program is stopped
//   RobotStatus      state and memory of the robot's program in the footer
//   EditorCommands   what buttons and keys do

import PHRASES from "../i18n/codemirror.texts.js";
import WORDS from "../i18n/editor.texts.js";
import { translator } from "../i18n/index.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h } from "../ui/dom.js";
import { allEvents } from "./aesl.js";
import { CHECK_SERVICE } from "./checking.js";
import { EditorCommands } from "./commands.js";
import { DebugMarkers } from "./debug_markers.js";
import { footer } from "./footer.js";
import { header } from "./header.js";
import { hintBar, repairLabel } from "./hint.js";
import { HelpTexts } from "./help_texts.js";
import { ProgramChecker } from "./program_checker.js";
import { RobotSelection } from "./robot_selection.js";
import { RobotStatus } from "./robot_status.js";
import { createText } from "./text.js";
import { toolbar, watchKeys } from "./toolbar.js";
import { toolbox } from "./tools/index.js";
import { ALL } from "./workspace.js";

import "./editor.css";

export { EditorSession } from "./editor_session.js";
export { splitEditorTopic } from "./state.js";

/**
 * @typedef {object} EditorOptions
 * @property {import("./editor_session.js").EditorSession} session
 * @property {import("../shell/context.js").Context} context
 */

export class Editor {
  #isScheduled = false;

  /** @param {EditorOptions} options */
  constructor({ session, context }) {
    const { store, language, announce, actions } = context;
    const pageText = context.text("page");
    this.session = session;
    this.store = store;
    this.pageText = pageText;
    const t = translator(language, WORDS);
    const { workspace } = session;
    this.runtime = actions.runtime;
    this.helpTexts = new HelpTexts(language);
    this.selection = new RobotSelection({ store, session, helpTexts: this.helpTexts });

    const redraw = () => this.redraw();
    /** @param {string} text @param {"good" | "warning" | "error"} kind */
    const report = (text, kind) => {
      this.foot.report({ text, kind });
      announce(text);
    };
    const code = h("div", { class: "code" });
    this.text = createText({
      parent: code,
      kept: session.texts,
      label: t("editor.code"),
      phrases: PHRASES[language] ?? {},
      vocabulary: () => this.#vocabulary(),
      changed: (content) => {
        workspace.edit(content);
        this.checker.checkSoon();
        redraw();
      },
      toggleBreakpoint: (line) => void this.markers.toggle(line),
      repairLabel: (content, repair) => repairLabel(t, content, repair),
      correct: () => this.checker.correct(),
    });
    const { runtime, selection, text } = this;
    const { view } = text;
    this.foot = footer(t, () => this.#goToRemark());
    const { foot } = this;
    const hints = hintBar(t, () => this.checker.correct());
    this.checker = new ProgramChecker({ t, language, runtime, workspace, text, hints, foot, announce, redraw });
    this.markers = new DebugMarkers({ t, runtime, workspace, selection, view, report, announce, redraw });
    this.status = new RobotStatus({ language, programText: context.text("program"), foot, announce });
    const { markers } = this;
    this.commands = new EditorCommands({
      t, pageText, language, session, actions, selection, view, markers, report, redraw,
    }); // prettier-ignore

    /** @param {import("./file_store.js").StoredFile} kept */
    const draftLabel = ({ name, time }) => t("editor.draft", { name, time: new Date(time).toLocaleString(language) });
    this.head = header({ t, draftLabel, session, redraw });
    this.bar = toolbar(t, this.commands, draftLabel);
    this.tools = toolbox({
      t,
      session,
      announce,
      redraw,
      insert(words) {
        view.dispatch(view.state.replaceSelection(words));
        view.focus();
      },
      setVariable: (variable, values) => runtime.setVariable(selection.robot, variable, values),
      emit: (event, values) => runtime.emit(selection.robot, event, values),
      define: (kind, entry, value) => {
        workspace.define(kind, entry, value);
        this.checker.checkSoon();
        redraw();
      },
    });
    this.element = h(
      "section",
      { class: "editor", "aria-label": t("editor") },
      this.head.element,
      this.bar.element,
      this.head.draft,
      h("div", { class: "editor-body" }, code, this.tools.element),
      h("div", { class: "editor-end" }, hints.element, foot.element),
    );
    this.removeKeys = watchKeys(this.element, this.commands);
    session.onText = () => this.#showText();
  }

  /** Call after the editor has been added to the page. */
  start() {
    this.#showText();
    this.#render();
    this.text.view.focus();
  }

  /** Call when the tab is shown again: sizes were not known while it was hidden. */
  show() {
    this.text.view.requestMeasure();
    this.redraw();
    this.text.view.focus();
  }

  /** @param {string} name @param {string} content */
  openText(name, content) {
    this.commands.openText(name, content);
  }

  /** @param {File} file */
  openFile(file) {
    void this.commands.open(file);
  }

  /** Draw with the next frame. */
  redraw() {
    if (this.#isScheduled || !this.element.isConnected) return;
    this.#isScheduled = true;
    requestAnimationFrame(() => {
      this.#isScheduled = false;
      this.#render();
    });
  }

  destroy() {
    this.checker.destroy();
    this.removeKeys();
    this.text.destroy();
    this.element.remove();
  }

  /** Show the current text of the workspace, which is another one. */
  #showText() {
    const { workspace } = this.session;
    this.text.show(`${workspace.tab} ${workspace.current.node} ${workspace.current.name}`, workspace.code);
    this.markers.forget();
    this.checker.restart();
    this.redraw();
  }

  #vocabulary() {
    const { file } = this.session.workspace;
    return {
      target: this.selection.target,
      events: allEvents(file),
      constants: file.constants,
      variables: this.checker.verdict?.variables ?? [],
    };
  }

  /** Put the cursor at the first error or warning. */
  #goToRemark() {
    const { line, column } = this.checker.firstRemark ?? {};
    const { view } = this.text;
    const { doc } = view.state;
    if (!line || line > doc.lines) return;
    const at = doc.line(line);
    const anchor = Math.min(at.from + (column ?? 1) - 1, at.to);
    view.dispatch({ selection: { anchor }, scrollIntoView: true });
    view.focus();
  }

  #render() {
    const { session, selection, store } = this;
    const { workspace } = session;
    const { services, simulator } = store.state;
    workspace.choose(selection.wanted);
    if (services.includes(CHECK_SERVICE)) void this.helpTexts.load(this.runtime, () => this.redraw());
    this.checker.retry(services);
    workspace.setRobotProgram(ALL, session.state.targets[store.state.selected]?.program);
    if (workspace.tab !== ALL) workspace.setRobotProgram(workspace.tab, selection.target?.program);

    const { file } = workspace;
    const reason = disabledReason(store.state, this.pageText);
    this.element.style.setProperty("--code-size", `${session.fontSize}px`);
    this.head.render(file);
    this.markers.render();
    this.status.render(selection.status?.values ?? {}, simulator?.paused ?? false, this.checker.verdict?.use);
    this.bar.render(workspace.fileStore.recent(), store.state.behaviors, reason);
    this.tools.render({
      robot: selection.robot,
      target: selection.target,
      variables: session.state.variables[selection.robot] ?? null,
      log: session.state.log,
      file,
      disabledReason: reason,
    });
  }
}
