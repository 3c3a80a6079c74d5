// The members of a mission's file that the form has no fields for, as text.

import { WORDS } from "../playground/mission.js";
import { h, setText } from "../ui/dom.js";

/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("../playground/rules.js").Phrase} Phrase */

/** Members that the form or the playground has. */
const ELSEWHERE = ["format", "title", "playground", "programs", "solutions"];

/**
 * The members of a text, or what is wrong with it. Pure.
 *
 * @param {string} text  JSON, or nothing
 * @returns {{ kept: Record<string, any>, problem: null } | { kept: null, problem: Phrase }}
 */
export function readByHand(text) {
  if (text.trim() === "") return { kept: {}, problem: null };
  /** @type {any} */ let kept = null;
  try {
    kept = JSON.parse(text);
  } catch (error) {
    return { kept: null, problem: { word: "problem.json", values: { reason: error instanceof Error ? error.message : "" } } };
  }
  if (typeof kept !== "object" || kept === null || Array.isArray(kept)) return { kept: null, problem: { word: "problem.json", values: { reason: "{ }" } } };
  const names = Object.keys(kept);
  const unknown = names.find((name) => !WORDS.includes(name) || ELSEWHERE.includes(name));
  if (unknown !== undefined) return { kept: null, problem: { word: "problem.word", values: { name: unknown } } };
  const flat = ["facts", "zones"].find((name) => name in kept && (typeof kept[name] !== "object" || kept[name] === null || Array.isArray(kept[name])));
  if (flat !== undefined) return { kept: null, problem: { word: "problem.json", values: { reason: `${flat}: { }` } } };
  return { kept, problem: null };
}

/** @param {import("./mission_parts.js").Part} part @param {Mission} mission */
export function byHand(part, mission) {
  const { labels } = part.setting;
  const { t } = labels;
  const id = "mission-kept";
  const text = Object.keys(mission.kept).length === 0 ? "" : JSON.stringify(mission.kept, null, 2);
  const problem = h("small", { class: "problem", id: `${id}-problem`, role: "alert", hidden: true });
  const input = h("textarea", { id, class: "input", rows: 6, spellcheck: "false", autocomplete: "off", "data-field": "kept", "aria-describedby": problem.id });
  input.value = text;
  input.addEventListener("change", () => {
    const read = readByHand(input.value);
    problem.hidden = read.problem === null;
    setText(problem, read.problem === null ? "" : labels.text(read.problem));
    input.setAttribute("aria-invalid", String(read.problem !== null));
    if (read.kept !== null) part.change({ kept: read.kept });
  });
  const names = Object.keys(mission.kept).join(", ");
  return h(
    "details",
    { class: "disc by-hand", open: names !== "" },
    h("summary", {}, t("mission.byHand")),
    h("p", { class: "small muted" }, t("mission.byHandHelp", { words: WORDS.filter((word) => !ELSEWHERE.includes(word)).join(", ") })),
    h("div", { class: "field" }, h("label", { class: "cap", for: id }, t("mission.kept")), input, problem),
  );
}
