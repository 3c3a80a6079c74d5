// What the teacher of a class has handed out to the reader of this page: a parameter of the page's node. Pure.

/** @typedef {{ id: string, kind: string, name: string, due: string, solution_of: string, opened: boolean, stars: number }} Handout */

const KINDS = ["program", "playground", "mission"];
let known = { text: "", handouts: /** @type {readonly Handout[]} */ ([]) };

/** The hand-outs in the value of the parameter, the newest first; none in another text. @param {unknown} value @returns {readonly Handout[]} */
export function readHandouts(value) {
  const text = String(value ?? "");
  if (text !== known.text) known = { text, handouts: listed(text) };
  return known.handouts;
}

/** @param {string} text @returns {readonly Handout[]} */
function listed(text) {
  try {
    const all = JSON.parse(text);
    return Array.isArray(all) ? all.filter(isHandout).reverse() : [];
  } catch {
    return [];
  }
}

/** @param {any} value @returns {value is Handout} */
function isHandout(value) {
  const { id, kind, name, due, solution_of: solutionOf, opened, stars } = value ?? {};
  const texts = [id, kind, name, due, solutionOf].every((each) => typeof each === "string");
  return texts && KINDS.includes(kind) && typeof opened === "boolean" && Number.isInteger(stars) && stars >= 0 && stars <= 3;
}
