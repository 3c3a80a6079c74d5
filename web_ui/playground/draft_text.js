// The text by which the browser keeps a playground, with its mission if it has one. Pure.

import { parse, write } from "./document.js";
import { GOAL_LISTS, goalOfKind, newMission, withMission } from "./mission.js";

/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./mission.js").Goal} Goal */

/** The text by which the browser keeps a playground. @param {Playground} playground */
export function writeDraft(playground) {
  const { mission } = playground;
  const text = write(playground);
  return mission === undefined ? text : JSON.stringify({ mission, playground: text });
}

/** The playground of such a text, or of a file. Throws a Fault. @param {string} text @returns {Playground} */
export function parseDraft(text) {
  /** @type {any} */ let data = null;
  try {
    data = JSON.parse(text);
  } catch {
    // `parse` says what is wrong.
  }
  if (typeof data?.playground !== "string") return parse(text);
  const mission = { ...newMission(), ...data.mission };
  const goals = GOAL_LISTS.map((list) => [list, mission[list].map((/** @type {Goal} */ goal) => ({ ...goalOfKind(goal.kind), ...goal }))]);
  return withMission(parse(data.playground), { ...mission, ...Object.fromEntries(goals) }); // an earlier version had fewer fields
}

/** The file of the playground alone, of what the browser keeps. @param {string} text */
export function playgroundOfDraft(text) {
  try {
    const { playground } = JSON.parse(text);
    return typeof playground === "string" ? playground : text;
  } catch {
    return text;
  }
}
