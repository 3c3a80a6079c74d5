// Programs as text: creates the objects of one view (hosts/program_host.js) and draws them.
//
//   TextField        the text (CodeMirror)
//   ProgramChecker   the compiler's verdict on the text
//   MistakeGuide     leads to mistakes, and repairs them
//   DebugMarkers     halt marks, and the line in which the program is halted
//   debugRow, toolbox, foot   line by line, values beside the text, room left

import PHRASES from "../i18n/codemirror.texts.js";
import { mistakesIn } from "../input/check_service.js";
import { disabledReason } from "../state/disabled_reason.js";
import { faultMessage } from "../state/program_status.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { allEvents } from "./aesl.js";
import { DebugMarkers } from "./debug_markers.js";
import { debugRow } from "./debug_row.js";
import { footOf } from "./foot.js";
import { isTaken } from "./help.js";
import { mistakeCard } from "./mistake_card.js";
import { MistakeGuide } from "./mistake_guide.js";
import { repairLabel } from "./mistakes.js";
import { Navigation } from "./navigation.js";
import { ProgramChecker } from "./program_checker.js";
import { signatureHelp } from "./signature.js";
import { skeletonText } from "./skeletons.js";
import { asebaText, FIELDS } from "./text.js";
import { TextField } from "./text_field.js";
import { toolbox } from "./tools/index.js";
import { ALL } from "./workspace.js";

import "./editor.css";

/** @typedef {import("../program_tab/tab.js").Parts} Parts */
/** @typedef {import("../hosts/program_host.js").ProgramView} ProgramView */

/** @implements {ProgramView} */
class TextView {
  /** @param {Parts} parts */
  constructor(parts) {
    const { t, context, session, choice, selection, redraw } = parts;
    const { workspace } = session;
    const { announce, language } = context;
    const { runtime } = context.actions;
    this.parts = parts;

    const code = h("div", { class: "code" });
    this.foot = footOf(t, () => this.guide.go());
    this.guide = new MistakeGuide({ t, text: () => this.text, foot: this.foot, announce });
    this.checker = new ProgramChecker({
      language,
      runtime,
      workspace,
      found: (finding) => {
        this.guide.found(finding);
        redraw();
      },
    });
    this.navigation = new Navigation({
      t,
      isTaken: (name, kind) => isTaken(name, kind, this.#vocabulary()),
      report: (text, kind) => this.report(text, kind),
    });
    this.text = new TextField({
      parent: code,
      kept: session.texts,
      isReadOnly: () => choice.isReadOnly,
      repairLabel: (content, repair) => repairLabel(t, content, repair),
      fields: FIELDS,
      extensions: asebaText({
        label: t("editor.code"),
        phrases: PHRASES[language] ?? {},
        vocabulary: () => this.#vocabulary(),
        changed: (content) => {
          workspace.edit(content);
          this.guide.typed();
          this.checker.checkSoon();
          redraw();
        },
        toggleBreakpoint: (line) => void this.markers.toggle(line),
        correct: () => this.guide.correct(),
        extensions: [
          mistakeCard({ t, correct: () => this.guide.correct() }),
          signatureHelp((name) => this.#native(name)),
          this.navigation.extension,
        ],
      }),
    });
    const { view } = this.text;
    this.markers = new DebugMarkers({
      t, runtime, workspace, selection, view, announce, redraw,
      report: (text, kind) => this.report(text, kind),
      placed: (place) => this.#placed(place),
    }); // prettier-ignore

    this.debug = this.#debugRow();
    this.tools = this.#toolbox();
    this.bar = this.debug.element;
    this.entries = this.#entries();
    this.element = h(
      "div",
      { class: "editor" },
      h("div", { class: "editor-body" }, code, this.tools.element),
      this.foot.element,
    );
  }

  show() {
    const { workspace } = this.parts.session;
    this.guide.forget();
    this.text.show(`${workspace.tab} ${workspace.current.node} ${workspace.current.name}`, workspace.code);
    this.markers.forget();
    this.checker.restart();
  }

  resized() {
    this.text.view.requestMeasure();
  }

  hasMistake() {
    return mistakesIn(this.checker.verdict).length > 0;
  }

  showMistake() {
    this.guide.go();
    this.parts.context.announce(this.parts.t("editor.runBlocked"));
  }

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  report(text, kind) {
    this.foot.report({ text, kind });
  }

  /** Send the current halt marks: one may have been set while the program was being loaded. */
  async loaded() {
    if (this.markers.lines.length > 0) await this.markers.send();
  }

  focus() {
    this.text.view.focus();
  }

  destroy() {
    this.checker.destroy();
    this.guide.destroy();
    this.text.destroy();
    this.bar.remove();
    this.element.remove();
  }

  redraw() {
    const { session, selection, context } = this.parts;
    const { state } = context.store;
    const { workspace } = session;
    this.checker.retry(state.services);
    const reason = disabledReason(state, context.text("page"));
    this.element.style.setProperty("--code-size", `${session.fontSize}px`);
    this.markers.render();
    const values = selection.status?.values ?? {};
    this.debug.render({
      state: values.state ?? "",
      robot: workspace.tab === ALL && selection.robots.length > 1 ? selection.robot : "",
      reason,
    });
    this.foot.memories(memoriesOf(values, this.checker.verdict?.use));
    this.tools.render({
      robot: selection.robot,
      target: selection.target,
      variables: session.state.variables[selection.robot] ?? null,
      log: session.state.log,
      file: workspace.file,
      code: workspace.code,
      disabledReason: reason,
    });
  }

  #vocabulary() {
    const { session, selection } = this.parts;
    const { file } = session.workspace;
    return {
      target: selection.target,
      events: allEvents(file),
      constants: file.constants,
      variables: this.checker.verdict?.variables ?? [],
    };
  }

  /** @param {string} name */
  #native(name) {
    return this.parts.selection.target?.natives.find((each) => each.name === name) ?? null;
  }

  /** Line by line, and a halt mark in the line of the cursor. */
  #debugRow() {
    const { view } = this.text;
    const { markers } = this;
    const line = () => view.state.doc.lineAt(view.state.selection.main.head).number;
    return debugRow({
      t: this.parts.t,
      commands: this.parts.commands,
      mark: {
        get isMarked() {
          return markers.lines.includes(line());
        },
        toggle: () => void markers.toggle(line()),
      },
    });
  }

  #toolbox() {
    const { t, context, session, selection, redraw } = this.parts;
    const { runtime } = context.actions;
    const { view } = this.text;
    return toolbox({
      t,
      session,
      announce: context.announce,
      redraw,
      insert(words) {
        if (view.state.readOnly) return;
        view.dispatch(view.state.replaceSelection(words));
        view.focus();
      },
      setVariable: (variable, values) => runtime.setVariable(selection.robot, variable, values),
      emit: (event, values) => runtime.emit(selection.robot, event, values),
      define: (kind, entry, value) => {
        session.workspace.define(kind, entry, value);
        this.checker.checkSoon();
        redraw();
      },
    });
  }

  /** What the text adds to the menu of the file. */
  #entries() {
    const { t, session, redraw } = this.parts;
    /** @param {string} name @param {import("../ui/icons.js").IconName} sign @param {string} keys @param {() => void} run */
    const entry = (name, sign, keys, run) => {
      const button = h(
        "button",
        {
          type: "button",
          class: "btn",
          "data-verb": name,
          onclick() {
            /** @type {HTMLElement | null} */ (button.closest("[popover]"))?.hidePopover();
            run();
          },
        },
        icon(sign, { small: true }),
        h("span", { class: "grow" }, t(`editor.${name}`)),
        h("kbd", { class: "kbd" }, keys),
      );
      return button;
    };
    const { navigation } = this;
    const entries = [
      entry("find", "search", "Ctrl+F", () => this.text.find()),
      entry("outline", "list", "Ctrl+Shift+O", () => navigation.openOutline(this.text.view)),
      entry("definition", "text", "F12", () => navigation.goToDefinition(this.text.view)),
      entry("rename", "pen", "F2", () => navigation.rename(this.text.view)),
    ];
    /** @param {string} name @param {string} sign @param {number} step */
    const sizer = (name, sign, step) =>
      h(
        "button",
        {
          type: "button",
          class: "btn line",
          title: t(`editor.${name}`),
          "aria-label": `${sign} ${t(`editor.${name}`)}`,
          onclick: () => {
            session.resize(step);
            redraw();
          },
        },
        sign,
      );
    return [...entries, h("div", { class: "row" }, sizer("smaller", "A−", -1), sizer("larger", "A+", 1))];
  }

  /** @param {import("./breakpoints.js").Place} place  where the program is halted or failed */
  #placed(place) {
    const { selection, context } = this.parts;
    const values = selection.status?.values ?? {};
    this.guide.failed(place?.fault ? place.line : 0, faultMessage(values, context.language));
  }
}

/**
 * Memory in use: of the shown text if it compiles, else what the robot reports.
 *
 * @param {Readonly<Record<string, string>>} values   status that the runtime reports
 * @param {import("../input/check_service.js").Use | null | undefined} use
 * @returns {Record<"variables" | "bytecode" | "stack", import("./foot.js").Share | null>}
 */
function memoriesOf(values, use) {
  /** @param {string} name @returns {import("./foot.js").Share | null} */
  const reported = (name) =>
    values[`${name}_size`] === undefined ? null : [Number(values[`${name}_used`]), Number(values[`${name}_size`])];
  return {
    variables: use?.variables ?? reported("variables"),
    bytecode: use?.bytecode ?? reported("bytecode"),
    stack: use?.stack ?? reported("stack"),
  };
}

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new TextView(parts);
}

/**
 * One of the programs to begin with; "" is an empty page.
 *
 * @param {string} name
 * @param {import("../i18n/index.js").Translate} t
 */
export function sampleText(name, t) {
  return name === "empty" ? "" : skeletonText(name, t);
}
