// ROS nodes in Python: the text, and what the node prints below it. The suite runs them (node_client.js).

import { lintGutter } from "@codemirror/lint";
import { lineNumbers } from "@codemirror/view";

import { TextField, basics } from "../editor/text_field.js";
import PHRASES from "../i18n/codemirror.texts.js";
import { robotTopic } from "../state/names.js";
import { h } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { nodeConsole } from "./console.js";
import { python } from "./language.js";
import SAMPLES from "./samples.texts.js";
import { errorIn } from "./traceback.js";

import "../editor/editor.css";
import "./python.css";

/** @typedef {import("../program_tab/tab.js").Parts} Parts */
/** @typedef {import("../hosts/program_host.js").ProgramView} ProgramView */
/** @typedef {import("./node_client.js").NodeClient} NodeClient */

/** @implements {ProgramView} */
class PythonView {
  /** The output whose error is marked. */ #marked = "";
  #said = "";

  /** @param {Parts} parts */
  constructor(parts) {
    const { t, context, session, node, redraw } = parts;
    const { workspace } = session;
    this.parts = parts;
    const code = h("div", { class: "code" });
    this.console = nodeConsole({ t, clear: () => node.clear(), go: () => this.#go() });
    this.note = h("p", { class: "note-box wait python-note", hidden: true }, icon("warning", { small: true }), h("span", {}));
    this.field = new TextField({
      parent: code,
      kept: session.texts,
      isReadOnly: () => false,
      extensions: [
        lineNumbers(),
        lintGutter(),
        basics({
          label: t("editor.code"),
          phrases: PHRASES[context.language] ?? {},
          changed: (text) => {
            workspace.edit(text);
            redraw();
          },
        }),
        python(),
      ],
    });
    /** @type {HTMLElement | null} */ this.bar = null;
    /** @type {readonly HTMLElement[]} */ this.entries = [];
    this.element = h("div", { class: "editor python" }, this.note, code, this.console.element);
    this.runner = {
      run: () => this.#run(),
      stop: () => node.stop(),
      isRunning: () => node.isRunning,
      reason: () => (node.mayRun ? "" : this.#whyNot()),
    };
  }

  show() {
    const { workspace } = this.parts.session;
    this.field.show(`${workspace.tab} ${workspace.current.name}`, workspace.code);
    this.#marked = "";
  }

  resized() {
    this.field.view.requestMeasure();
  }

  hasMistake() {
    return false; // Python finds them when it runs
  }

  showMistake() {}

  /** @param {string} text @param {"good" | "warning" | "error"} kind */
  report(text, kind) {
    const { context } = this.parts;
    if (kind !== "good") context.store.dispatch({ type: "notice", level: kind === "error" ? "error" : "info", text, cause: "program" });
  }

  async loaded() {}

  focus() {
    this.field.view.focus();
  }

  destroy() {
    this.field.destroy();
    this.element.remove();
  }

  redraw() {
    const { session, node } = this.parts;
    this.element.style.setProperty("--code-size", `${session.fontSize}px`);
    const reason = this.#whyNot();
    this.note.hidden = reason === "";
    /** @type {HTMLElement} */ (this.note.lastElementChild).textContent = reason;
    const error = this.#error();
    const mistake = error === null ? "" : this.parts.t("python.error", { ...error });
    this.console.render({ output: node.output, ...this.#state(), mistake });
    this.#mark(error);
    this.#say();
  }

  /** What the node does, in words. */
  #state() {
    const { t, node } = this.parts;
    if (node.state !== "idle") {
      return { now: t(`python.${node.state}`), tone: node.state === "running" ? "run" : "wait" };
    }
    if (node.end === null) return { now: "", tone: "" };
    const { reason, text } = node.end;
    if (reason !== "") return { now: t(`python.end.${reason}`, { text }), tone: "stop" };
    return this.#error() === null ? { now: t("python.ended"), tone: "" } : { now: t("python.failed"), tone: "stop" };
  }

  /** The error with which the last node has ended. */
  #error() {
    const { program, end, output } = this.parts.node;
    return program === null || end === null || end.code === 0 ? null : errorIn(output, program.name);
  }

  /** Why nodes cannot run here; "": they can, or it is not known yet. */
  #whyNot() {
    const { t, node } = this.parts;
    return node.mayRun || node.right === "" ? "" : t(`python.not.${node.right}`);
  }

  /** Mark the line of an error while the text is the one that has run. @param {import("./traceback.js").PythonError | null} error */
  #mark(error) {
    const { program } = this.parts.node;
    const { doc } = this.field.view.state;
    const isSame = program?.name === this.parts.session.workspace.current.name && program.text === doc.toString();
    const line = isSame && error !== null && error.line <= doc.lines ? doc.line(error.line) : null;
    const key = line === null || error === null ? "none" : `${error.line} ${error.message}`;
    if (key === this.#marked) return;
    this.#marked = key;
    if (line === null || error === null) return this.field.mark([]);
    const from = line.from + (/^\s*/.exec(line.text)?.[0].length ?? 0);
    this.field.mark([{ from, to: line.to, severity: "error", message: error.message }]);
    this.#go();
  }

  /** Show the line of the error. */
  #go() {
    const { view } = this.field;
    const { doc } = view.state;
    const line = doc.line(Math.min(this.#error()?.line ?? 1, doc.lines));
    view.dispatch({ selection: { anchor: line.to }, scrollIntoView: true });
    view.focus();
  }

  /** Tell screen readers how the node has ended. */
  #say() {
    const { t, context } = this.parts;
    const error = this.#error();
    const said = error === null ? this.#state().now : t("python.error", { ...error });
    if (said === this.#said) return;
    this.#said = said;
    if (said !== "") context.announce(said);
  }

  async #run() {
    const { session, node, context, selection } = this.parts;
    const { actions, store } = context;
    const { name } = session.workspace.current;
    const text = this.field.view.state.doc.toString();
    const namespace = robotTopic(selection.robot, "").replace(/\/$/, "");
    node.run({ name, text, namespace, sim_time: store.state.simulator !== null }, async () => {
      if (store.state.mission !== null) await actions.call("/simulator/reset"); // a try begins with the program
      if (store.state.simulator?.paused) await actions.pause(false);
    });
  }
}

/** @param {Parts} parts @returns {ProgramView} */
export function createView(parts) {
  return new PythonView(parts);
}

/** One of the programs to begin with. @param {string} name */
export function sampleText(name) {
  return SAMPLES[/** @type {keyof typeof SAMPLES} */ (name)];
}
