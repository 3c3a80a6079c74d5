// The state of the robot's program in words, and its use of memory: drawn in the footer, announced on change.

import { faultMessage, lineLabel, stateLabel } from "../state/program_status.js";

export class RobotStatus {
  #announced = "";

  /**
   * @param {object} options
   * @param {string} options.language
   * @param {import("../i18n/index.js").Translate} options.programText
   * @param {ReturnType<typeof import("./footer.js").footer>} options.foot
   * @param {(text: string) => void} options.announce
   */
  constructor({ language, programText, foot, announce }) {
    this.language = language;
    this.programText = programText;
    this.foot = foot;
    this.announce = announce;
  }

  /**
   * @param {Readonly<Record<string, string>>} values   reported by the runtime
   * @param {boolean} timePaused
   * @param {import("./checking.js").Use | null | undefined} use   of the shown text; unknown: what the robot reports
   */
  render(values, timePaused, use) {
    const { state = "" } = values;
    const words = state ? stateLabel(state, this.programText, timePaused) + lineLabel(values, this.programText) : "";
    const fault = faultMessage(values, this.language);
    const sentence = words + (fault ? `: ${fault}` : "");
    this.foot.robot(timePaused && state === "running" ? "paused" : state, sentence);
    if (sentence !== this.#announced) {
      this.#announced = sentence;
      this.announce(sentence);
    }
    /** @param {string} name @returns {import("./footer.js").Share} */
    const reported = (name) =>
      values[`${name}_size`] === undefined ? null : [Number(values[`${name}_used`]), Number(values[`${name}_size`])];
    this.foot.memories({
      variables: use?.variables ?? reported("variables"),
      bytecode: use?.bytecode ?? reported("bytecode"),
      stack: use?.stack ?? reported("stack"),
    });
  }
}
