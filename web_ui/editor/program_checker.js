// Checks the shown text with the compiler of the runtime, some time after the last change.

import { CHECK_SERVICE } from "../input/check_service.js";
import { allEvents } from "./aesl.js";

const CHECK_DELAY_MS = 300;

/** @typedef {import("../input/check_service.js").Verdict} Verdict */
/**
 * @typedef {object} Finding
 * @property {string} source            the checked text
 * @property {Verdict | null} verdict   null: the service did not answer
 * @property {boolean} isTyping         whether the user was typing
 */

export class ProgramChecker {
  /** @type {Verdict | null} result for the shown text; null: not known yet */
  verdict = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  #timer;
  #number = 0;
  /** The check service was not available for the last check. */
  #isPending = false;

  /**
   * @param {object} options
   * @param {string} options.language
   * @param {import("../input/runtime_client.js").RuntimeClient} options.runtime
   * @param {import("./workspace.js").Workspace} options.workspace
   * @param {(finding: Finding) => void} options.found
   */
  constructor({ language, runtime, workspace, found }) {
    this.language = language;
    this.runtime = runtime;
    this.workspace = workspace;
    this.found = found;
  }

  /** Check the text shortly after the last change. */
  checkSoon() {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => void this.check(true), CHECK_DELAY_MS);
  }

  /** Check another text: discard the result of the previous one. */
  restart() {
    clearTimeout(this.#timer);
    this.verdict = null;
    void this.check();
  }

  /** Repeat a check that failed, as soon as the service is available. @param {readonly string[]} services */
  retry(services) {
    if (this.#isPending && services.includes(CHECK_SERVICE)) void this.check();
  }

  async check(isTyping = false) {
    this.#isPending = false;
    const number = ++this.#number;
    const source = this.workspace.code;
    const { file } = this.workspace;
    const question = { source, language: this.language, events: allEvents(file), constants: file.constants };
    const verdict = await this.runtime.check(question);
    if (number !== this.#number || source !== this.workspace.code) return; // a newer check is in progress
    this.verdict = verdict;
    this.#isPending = verdict === null;
    this.found({ source, verdict, isTyping });
  }

  destroy() {
    clearTimeout(this.#timer);
    this.#number += 1; // no answer is shown any more
  }
}
