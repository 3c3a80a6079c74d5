// What all languages of programs share: the head with run and stop, the menu of the file, the badge, drafts, and the
// ways to begin a program. The language itself is a view (hosts/program_host.js).

import { isPython } from "../browser/python_name.js";
import { isInRobot, isUnsaved } from "../editor/documents.js";
import { HelpTexts } from "../editor/help_texts.js";
import { RobotSelection } from "../editor/robot_selection.js";
import { ALL } from "../editor/workspace.js";
import { exampleTitle, isExample, NO_PROGRAM, WELCOME } from "../examples/index.js";
import WORDS from "../i18n/editor.texts.js";
import { translator } from "../i18n/index.js";
import { CHECK_SERVICE } from "../input/check_service.js";
import { disabledReason } from "../state/disabled_reason.js";
import { h, setAttribute } from "../ui/dom.js";
import { isSomethingOpen } from "../ui/sheet.js";
import { ProgramCommands } from "./commands.js";
import { draftBar } from "./draft_bar.js";
import { fileMenu } from "./file_menu.js";
import { foreignBar, instructionsOf } from "./foreign_bar.js";
import { watchKeys } from "./keys.js";
import { languageBar } from "./language_bar.js";
import { programBadge } from "./program_badge.js";
import { programHead } from "./program_head.js";
import { StartPage } from "./start_page.js";

import "./program.css";

export { EditorSession } from "../editor/editor_session.js";
export { NodeClient } from "../python/node_client.js";

/** The language of ROS nodes. */
const NODE = "ros";

/** Narrower tabs have the menu of the file in the head, as the tabs leave no room for it. */
const WIDE_PX = 640;

/** @typedef {import("../hosts/program_host.js").Language} Language */
/** @typedef {import("../hosts/program_host.js").LanguageModule} LanguageModule */
/** @typedef {import("../hosts/program_host.js").ProgramView} ProgramView */
/**
 * @typedef {object} Parts   what a language gets
 * @property {import("../i18n/index.js").Translate} t
 * @property {import("../shell/context.js").Context} context
 * @property {import("../editor/editor_session.js").EditorSession} session
 * @property {import("./language_choice.js").LanguageChoice} choice   whether the text is made from a picture
 * @property {RobotSelection} selection
 * @property {ProgramCommands} commands
 * @property {import("../python/node_client.js").NodeClient} node   the ROS node of this page
 * @property {() => void} redraw
 */

export class ProgramTab {
  #isScheduled = false;
  /** @type {ProgramView | null} */ #view = null;
  /** The language of the view, or of the one that is being loaded. */ #language = "";
  #isStartShown = false;
  #wasShown = false;

  /**
   * @param {object} options
   * @param {import("../editor/editor_session.js").EditorSession} options.session
   * @param {import("../shell/context.js").Context} options.context
   * @param {readonly import("../hosts/program_host.js").Language[]} options.languages
   * @param {import("./language_choice.js").LanguageChoice} options.choice
   * @param {import("../python/node_client.js").NodeClient} options.node
   * @param {(language: Language) => Promise<LanguageModule | null>} options.load
   * @param {(id: string) => void} options.show   shows the document in a language, by `setView`
   */
  constructor({ session, choice, node, context, languages, load, show }) {
    const { store, language, actions, announce } = context;
    const t = translator(language, WORDS);
    this.session = session;
    this.choice = choice;
    this.node = node;
    this.show = show;
    this.context = context;
    this.languages = languages;
    this.t = t;
    this.pageText = context.text("page");
    this.exampleText = context.text("examples");
    this.helpTexts = new HelpTexts(language);
    this.selection = new RobotSelection({ store, session, helpTexts: this.helpTexts });
    const redraw = () => this.redraw();
    this.commands = new ProgramCommands({
      t,
      pageText: this.pageText,
      language,
      session,
      choice,
      languages,
      load,
      actions,
      selection: this.selection,
      view: () => this.#view,
      report: (text, kind) => {
        const level = kind === "error" ? "error" : "info";
        if (this.#isStartShown && kind !== "good") store.dispatch({ type: "notice", level, text, cause: "program" });
        else this.#view?.report(text, kind);
        announce(text);
      },
      redraw,
    });
    const { commands } = this;
    /** @param {import("../editor/file_store.js").StoredFile} kept */
    const draftLabel = ({ name, time }) => t("editor.draft", { name, time: new Date(time).toLocaleString(language) });
    this.head = programHead({ t, languages, choose: (id) => this.#choose(id), commands });
    this.file = fileMenu({ t, session, commands, share: context.share, redraw });
    this.badge = programBadge(context.text("program"));
    this.draft = draftBar({ t, draftLabel, workspace: session.workspace, redraw });
    this.foreign = foreignBar(t);
    this.languageBar = languageBar({
      t,
      choice,
      detach: () => void commands.detach(),
      changed: () => this.#follow(),
    });
    const timeLabel = (/** @type {number} */ time) =>
      new Date(time).toLocaleString(language, { dateStyle: "short", timeStyle: "short" });
    this.start = new StartPage({ t, exampleText: this.exampleText, draftLabel, timeLabel, commands, languages });
    this.bar = h("div", { class: "program-row" }, h("span", { class: "grow" }), this.badge.element);
    this.place = h("div", { class: "program-view" }, this.languageBar.element, this.bar);
    this.element = h(
      "section",
      { class: "program", "aria-label": t("editor") },
      this.head.element,
      this.draft.element,
      this.foreign.element,
      this.place,
      this.start.element,
    );
    this.removeKeys = watchKeys(this.element, commands);
    this.sizes = new ResizeObserver(() => this.#placeFileMenu());
    this.sizes.observe(this.element);
    session.onText = () => this.#follow();
    session.onOffer = redraw;
  }

  /**
   * Show the program in a language.
   *
   * @param {string} id
   * @param {import("../hosts/program_host.js").CreateView} createView
   */
  setView(id, createView) {
    this.#view?.destroy();
    const { t, context, session, choice, node, selection, commands } = this;
    const view = createView({ t, context, session, choice, node, selection, commands, redraw: () => this.redraw() });
    this.#view = view;
    this.#language = id;
    if (view.bar !== null) this.bar.prepend(view.bar);
    this.place.append(view.element);
    this.file.setEntries(view.entries);
    view.show();
    this.#render();
    const { activeElement } = document;
    const isFree = activeElement === document.body || this.element.contains(activeElement);
    if (isFree || !this.#wasShown) this.#focus();
    this.#wasShown = true;
  }

  /** Another document is shown, or it is in another language now. */
  #follow() {
    const { shown } = this.choice;
    if (shown !== this.#language || this.#view === null) {
      this.#view?.destroy(); // it must not see a document that it cannot read
      this.#view = null;
      this.#language = shown;
      this.show(shown);
    } else this.#view?.show();
    this.redraw();
  }

  /** Show the document in a language, or begin a program in it. @param {string} id */
  #choose(id) {
    const isNew = this.#isStartShown || this.choice.choose(id) === "new";
    if (!isNew) return this.#follow();
    this.start.prefer(id);
    this.commands.newFile();
    this.start.focus();
  }

  /** Call when the tab is opened or left. @param {boolean} isShown */
  setShown(isShown) {
    this.file.element.hidden = !isShown;
    if (!isShown) return;
    this.#view?.resized();
    this.redraw();
    this.#focus();
  }

  #focus() {
    if (isSomethingOpen()) return; // the user is in a menu that was opened while the language was loaded
    if (this.#isStartShown) this.start.focus();
    else this.#view?.focus();
  }

  /** Draw with the next frame. */
  redraw() {
    if (this.#isScheduled || !this.element.isConnected) return;
    this.#isScheduled = true;
    requestAnimationFrame(() => {
      this.#isScheduled = false;
      if (this.element.isConnected) this.#render();
    });
  }

  destroy() {
    this.#view?.destroy();
    this.removeKeys();
    this.sizes.disconnect();
    this.file.element.remove();
    this.element.remove();
  }

  /** Whether it is known what there is to show: the robot has reported its program, or there is a text already. */
  get #isKnown() {
    const { current } = this.session.workspace;
    return this.selection.target !== null || current.own || isUnsaved(current);
  }

  /** Whether there is nothing to look at yet: an empty page, or a robot that waits for a program. */
  get #isBeginning() {
    const { current } = this.session.workspace;
    const { target } = this.selection;
    if (current.own || isUnsaved(current) || target === null) return false;
    return !target.program?.source.trim() || isExample(target.program.name, WELCOME);
  }

  /** The name of the program that the robot has; empty: none. */
  get #title() {
    const { status, target } = this.selection;
    if (status === null || status.name === NO_PROGRAM) return "";
    const isForeign = instructionsOf(target?.program) !== null;
    return isForeign ? this.t("foreign.name") : exampleTitle(status.name, this.exampleText);
  }

  #placeFileMenu() {
    const end = document.querySelector('[data-slot="tab-end"]');
    const isWide = this.element.clientWidth >= WIDE_PX && end?.checkVisibility() === true;
    const place = isWide ? end : this.head.place;
    setAttribute(this.file.element, "data-wide", String(isWide));
    if (this.file.element.parentElement !== place) place.append(this.file.element);
  }

  #render() {
    const { session, selection, context, pageText } = this;
    const { workspace } = session;
    const { state } = context.store;
    workspace.choose(selection.wanted);
    if (state.services.includes(CHECK_SERVICE)) void this.helpTexts.load(context.actions.runtime, () => this.redraw());
    workspace.setRobotProgram(ALL, session.state.targets[state.selected]?.program);
    if (workspace.tab !== ALL) workspace.setRobotProgram(workspace.tab, selection.target?.program);

    const runner = this.#view?.runner;
    const reason = disabledReason(state, pageText) || (runner?.reason() ?? "");
    const { current } = workspace;
    const { status } = selection;
    this.#showStart(session.isChoosing || this.#isBeginning);
    const hasMistake = this.#view?.hasMistake() ?? false;
    const allowed = this.#offered(context.mission.editors);
    this.head.render({ reason, hasMistake, isStart: this.#isStartShown, shown: this.choice.shown, allowed });
    this.file.render({ reason, isUnsaved: isUnsaved(current), hasMistake });
    this.bar.hidden = runner !== undefined;
    this.badge.render({
      values: status?.values ?? {},
      title: this.#title,
      timePaused: state.simulator?.paused ?? false,
      isTextInRobot: isInRobot(current),
      wasInRobot: current.loaded !== null && current.own,
    });
    this.draft.render();
    this.foreign.render(selection.target?.program);
    this.languageBar.render();
    if (this.#isStartShown) {
      this.start.render({ state, reason, recent: workspace.fileStore.recent(), canGoBack: !this.#isBeginning, allowed });
    } else this.#view?.redraw();
  }

  /** The languages that are offered: nodes only where they can run. @param {readonly string[] | null} allowed  null: all */
  #offered(allowed) {
    if (this.node.mayRun || isPython(this.session.workspace.current.name)) return allowed;
    return (allowed ?? this.languages.map(({ id }) => id)).filter((id) => id !== NODE);
  }

  /** Show the ways to begin, or the program. @param {boolean} isStart */
  #showStart(isStart) {
    setAttribute(this.element, "data-shown", isStart ? "start" : this.#isKnown ? "program" : "wait");
    if (isStart === this.#isStartShown) return;
    this.#isStartShown = isStart;
    const hadFocus = document.activeElement === document.body || this.element.contains(document.activeElement);
    this.start.element.hidden = !isStart;
    this.place.hidden = isStart;
    if (!isStart) this.#view?.resized();
    if (hadFocus) this.#focus();
  }
}
