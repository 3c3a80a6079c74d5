// Checks the shown text with the compiler of the runtime, and applies its proposed repair.

import { allEvents } from "./aesl.js";
import { CHECK_SERVICE, marks } from "./checking.js";
import { repairLabel } from "./hint.js";

const CHECK_DELAY_MS = 300;

/** @typedef {import("./checking.js").Verdict} Verdict */

export class ProgramChecker {
  /** @type {Verdict | null} result for the shown text; null: not known yet */
  verdict = null;
  /** @type {{ text: string, repair: import("./checking.js").Repair } | null} */
  #correction = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;
  #number = 0;
  /** The check service was not available for the last check. */
  #isPending = false;

  /**
   * @param {object} options
   * @param {import("../i18n/index.js").Translate} options.t
   * @param {string} options.language
   * @param {import("../input/runtime_client.js").RuntimeClient} options.runtime
   * @param {import("./workspace.js").Workspace} options.workspace
   * @param {import("./text.js").TextField} options.text
   * @param {ReturnType<typeof import("./hint.js").hintBar>} options.hints
   * @param {ReturnType<typeof import("./footer.js").footer>} options.foot
   * @param {(text: string) => void} options.announce
   * @param {() => void} options.redraw
   */
  constructor({ t, language, runtime, workspace, text, hints, foot, announce, redraw }) {
    this.t = t;
    this.language = language;
    this.runtime = runtime;
    this.workspace = workspace;
    this.text = text;
    this.hints = hints;
    this.foot = foot;
    this.announce = announce;
    this.redraw = redraw;
  }

  /** The first error, else the first warning; undefined if there is none. */
  get firstRemark() {
    return [...(this.verdict?.errors ?? []), ...(this.verdict?.warnings ?? [])][0];
  }

  /** Check the text shortly after the last change. */
  checkSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.check(), CHECK_DELAY_MS);
  }

  /** Check another text: discard the results of the previous one. */
  restart() {
    this.verdict = null;
    this.#correction = null;
    this.hints.show(null);
    void this.check();
  }

  /** Repeat a check that failed, as soon as the service is available. @param {readonly string[]} services */
  retry(services) {
    if (this.#isPending && services.includes(CHECK_SERVICE)) void this.check();
  }

  async check() {
    this.#isPending = false;
    const number = ++this.#number;
    const source = this.workspace.code;
    const { file } = this.workspace;
    const question = { source, language: this.language, events: allEvents(file), constants: file.constants };
    const answer = await this.runtime.check(question);
    if (number !== this.#number || source !== this.workspace.code) return; // a newer check is in progress
    this.verdict = answer;
    if (answer === null) {
      this.#isPending = true;
      this.foot.report({ text: this.t("check.unknown"), kind: "" });
      return;
    }
    this.#show(source, answer);
    this.redraw();
  }

  /** @param {string} source @param {Verdict} verdict */
  #show(source, verdict) {
    const { t } = this;
    const found = marks(source, verdict);
    this.text.mark(found);
    const { hint = "", repair = null } = found.find((mark) => mark.hint !== undefined) ?? {};
    this.#correction = repair && { text: source, repair };
    this.hints.show(hint === "" ? null : { text: hint, button: repair === null ? "" : repairLabel(t, source, repair) });
    const first = this.firstRemark;
    if (first === undefined) return this.foot.report({ text: `✓ ${t("check.ok")}`, kind: "good" });
    const kind = verdict.errors.length > 0 ? "error" : "warning";
    const message = first.line === null ? first.message : t("check.error", { line: first.line, message: first.message });
    this.foot.report({ text: `${kind === "error" ? "✕" : "⚠"} ${message}`, kind });
    if (kind === "error") this.announce(hint === "" ? message : `${message}. ${hint}`);
  }

  /** Apply the proposed repair; the text is checked again. */
  correct() {
    if (this.#correction === null || !this.text.repair(this.#correction.text, this.#correction.repair)) return;
    this.#correction = null;
    this.hints.show(null);
    this.announce(this.t("hint.done"));
  }

  destroy() {
    clearTimeout(this.#timer);
  }
}
