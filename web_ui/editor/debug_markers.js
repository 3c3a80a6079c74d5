// Breakpoints of the shown text and the line at which its program is stopped: sent to the robot, and drawn as the
// robot reports them. Lines of the robot count from the first line of the node in its file.

import { lineOf } from "../state/program_status.js";
import { breakpointLines, showBreakpoints, showPlace } from "./breakpoints.js";

export class DebugMarkers {
  /** @type {unknown} the status that is drawn, or OTHER; null: none */
  #drawn = null;

  /**
   * @param {object} options
   * @param {import("../i18n/index.js").Translate} options.t
   * @param {import("../input/runtime_client.js").RuntimeClient} options.runtime
   * @param {import("./workspace.js").Workspace} options.workspace
   * @param {import("./robot_selection.js").RobotSelection} options.selection
   * @param {import("@codemirror/view").EditorView} options.view
   * @param {(text: string, kind: "error") => void} options.report
   * @param {(text: string) => void} options.announce
   * @param {() => void} options.redraw
   * @param {(place: import("./breakpoints.js").Place) => void} options.placed   called with the line in which it is
   *   halted or failed; null: none
   */
  constructor({ t, runtime, workspace, selection, view, report, announce, redraw, placed }) {
    this.t = t;
    this.runtime = runtime;
    this.workspace = workspace;
    this.selection = selection;
    this.view = view;
    this.report = report;
    this.announce = announce;
    this.redraw = redraw;
    this.placed = placed;
  }

  get #firstLine() {
    return Number(this.selection.status?.values.first_line ?? 1) || 1;
  }

  /** Lines with a breakpoint, from 1. */
  get lines() {
    return breakpointLines(this.view.state);
  }

  /** @param {number} line */
  async toggle(line) {
    const { lines } = this;
    const wanted = lines.includes(line) ? lines.filter((each) => each !== line) : [...lines, line];
    showBreakpoints(this.view, wanted);
    if (this.workspace.isInRobot) await this.send();
  }

  /** Send the breakpoints to the robot. */
  async send() {
    const lines = this.lines.map((line) => line + this.#firstLine - 1);
    const { ok, message } = await this.runtime.setBreakpoints(this.selection.owner, lines);
    if (ok) return;
    this.report(message, "error");
    this.forget(); // restores the breakpoints in effect
    this.redraw();
  }

  /** Draw the status again even if it is the same: the text is another one. */
  forget() {
    this.#drawn = null;
  }

  /** Draw what the robot reports, if it runs the shown text and the report has changed. */
  render() {
    const { status, isTextRunning } = this.selection;
    const reported = status !== null && isTextRunning ? status : OTHER;
    if (reported === this.#drawn) return;
    this.#drawn = reported;
    if (reported === OTHER || status === null) {
      this.placed(null);
      return showPlace(this.view, null);
    }
    const first = this.#firstLine;
    const { values } = status;
    const inEffect = JSON.parse(values.breakpoints || "[]").map((/** @type {number} */ line) => line - first + 1);
    showBreakpoints(this.view, inEffect);
    const line = lineOf(values);
    const place = line > 0 ? { line, fault: values.state === "fault" } : null;
    showPlace(this.view, place);
    this.placed(place);
    for (const [wanted, moved] of Object.entries(JSON.parse(values.breakpoints_moved || "{}"))) {
      if (moved === null) this.announce(this.t("breakpoint.none", { line: Number(wanted) - first + 1 }));
    }
  }
}

/** Stands for the status of a robot that runs another text. */
const OTHER = Symbol("other text");
