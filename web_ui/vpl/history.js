// The undo history of a VPL program: whole programs. Immutable, at most 50 steps.

/** @typedef {import("./program.js").Program} Program */
/**
 * @typedef {object} History
 * @property {Program} present
 * @property {string} series              the gesture of the last edit, such as of one slider; "" if it is over
 * @property {readonly Program[]} past    the last one is undone first
 * @property {readonly Program[]} future  the first one is redone first
 */

export const DEPTH = 50;

/** @param {Program} present @returns {History} */
export function newHistory(present) {
  return { present, series: "", past: [], future: [] };
}

/**
 * The history after an edit. Consecutive edits of one series are undone together.
 *
 * @param {History} history
 * @param {Program} next
 * @param {string} [series]  such as "row 3, speed"
 * @returns {History}
 */
export function record(history, next, series = "") {
  if (next === history.present) return history;
  const goesOn = series !== "" && series === history.series;
  const past = goesOn ? history.past : [...history.past, history.present].slice(-DEPTH);
  return { present: next, series, past, future: [] };
}

/** End a series: the next edit is a step of its own. @param {History} history @returns {History} */
export function endSeries(history) {
  return { ...history, series: "" };
}

/** @param {History} history @returns {History} */
export function undo({ present, past, future, series }) {
  const last = past.at(-1);
  if (last === undefined) return { present, past, future, series };
  return { present: last, series: "", past: past.slice(0, -1), future: [present, ...future] };
}

/** @param {History} history @returns {History} */
export function redo({ present, past, future, series }) {
  const [next, ...later] = future;
  if (next === undefined) return { present, past, future, series };
  return { present: next, series: "", past: [...past, present], future: later };
}
