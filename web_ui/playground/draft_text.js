// The text by which the browser keeps a playground, with its mission if it has one. Pure.

import { parse, write } from "./document.js";

/** @typedef {import("./document.js").Playground} Playground */

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
  return { ...parse(data.playground), mission: data.mission };
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
