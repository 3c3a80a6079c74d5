// The badge: what the robot's program does, in one word, and whether it is the version that is shown.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { stateLabel, stateWithLine } from "../state/program_status.js";

/** @typedef {"" | "run" | "wait" | "stop"} Tone */
/**
 * @typedef {object} Facts
 * @property {Readonly<Record<string, string>>} values   status that the runtime reports; empty: none
 * @property {string} title          of the program in the robot; empty: none
 * @property {boolean} timePaused
 * @property {boolean} isTextInRobot   whether the robot has exactly the text that is shown
 * @property {boolean} wasInRobot      whether it had an earlier version of the text
 */
/** @typedef {{ state: string, text: string, tone: Tone, sign: import("../ui/icons.js").IconName | null }} Badge */

/** @type {Readonly<Record<string, { tone: Tone, sign: Badge["sign"] }>>} */
const LOOKS = {
  running: { tone: "run", sign: null },
  timePaused: { tone: "wait", sign: "pause" },
  paused: { tone: "wait", sign: "halt" },
  fault: { tone: "stop", sign: "warning" },
  older: { tone: "wait", sign: "warning" },
};
const PLAIN = { tone: /** @type {Tone} */ (""), sign: null };

/**
 * What the badge says. Pure.
 *
 * @param {Facts} facts
 * @param {import("../i18n/index.js").Translate} t  texts of the programs
 * @returns {Badge}
 */
export function badgeOf({ values, title, timePaused, isTextInRobot, wasInRobot }, t) {
  const { state = "" } = values;
  /** @param {string} name @param {string} text @returns {Badge} */
  const badge = (name, text) => ({ state: name, text, ...(LOOKS[name] ?? PLAIN) });
  if (state === "") return badge("", "");
  if (title === "" && !isTextInRobot) return badge("idle", t("state.idle"));
  if (state === "running" && timePaused) return badge("timePaused", t("state.timePaused"));
  if (state === "running" && !isTextInRobot) {
    return wasInRobot ? badge("older", t("state.older")) : badge("other", t("state.other", { name: title }));
  }
  return badge(state, isTextInRobot ? stateWithLine(values, t) : stateLabel(state, t));
}

/** @param {import("../i18n/index.js").Translate} t  texts of the programs */
export function programBadge(t) {
  const sign = h("span", { class: "program-sign", "aria-hidden": "true" });
  const words = h("span", {});
  const element = h("span", { class: "chip", id: "program-state" }, sign, words);
  let shown = "";
  return {
    element,
    /** @param {Facts} facts */
    render(facts) {
      const { state, text, tone, sign: name } = badgeOf(facts, t);
      setText(words, text);
      element.hidden = text === "";
      if (state === shown) return;
      shown = state;
      setAttribute(element, "data-state", state);
      setAttribute(element, "class", `chip ${tone}`.trim());
      sign.replaceChildren(name === null ? h("i", { class: "lamp" }) : icon(name, { small: true }));
    },
  };
}
