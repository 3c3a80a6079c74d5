// One program being edited: a whole .aesl file, of which one node's code is on the screen. Values, no screen.

import { looksLikeAesl, newAesl, readAesl, withCode, withEntry, withLast } from "./aesl.js";

/**
 * @typedef {object} Document
 * @property {string} name
 * @property {string} text            of the .aesl file as it would be saved
 * @property {number} node            which of its nodes is shown
 * @property {string} saved           text as last opened, saved or taken from a robot
 * @property {string | null} loaded   text as last loaded into a robot or taken from it; null: never
 * @property {string | null} source   the robot's source that it was taken from or that was loaded
 * @property {boolean} own            whether a person began or opened it
 */

export const UNTITLED = "program.aesl";

/** @param {string} [name] @returns {Document} */
export function blank(name = UNTITLED) {
  const text = newAesl();
  return { name, text, node: 0, saved: text, loaded: null, source: null, own: false };
}

/**
 * A file or a bare program from elsewhere; AeslError for what is no .aesl file.
 *
 * @param {string} name
 * @param {string} text
 * @returns {Document}
 */
export function opened(name, text) {
  const wrapped = looksLikeAesl(text) ? text : newAesl(text.replaceAll("\r\n", "\n"));
  const { nodes } = readAesl(wrapped);
  const whole =
    nodes.length > 0
      ? wrapped
      : withLast(wrapped, '<node nodeId="1" name="thymio-II"></node>\n');
  return { name: name || UNTITLED, text: whole, node: 0, saved: whole, loaded: null, source: null, own: true };
}

/**
 * What a robot has.
 *
 * @param {{ name: string, file: string, node?: string }} program
 * @returns {Document}
 */
export function fromRobot({ name, file, node = "" }) {
  const document = opened(name, file);
  const index = readAesl(document.text).nodes.findIndex((each) => each.name === node);
  return { ...document, node: Math.max(index, 0), loaded: document.text, source: file, own: false };
}

/** @param {Document} document @returns {string} */
export function codeOf({ text, node }) {
  return readAesl(text).nodes[node].code;
}

/** @param {Document} document @param {string} code @returns {Document} */
export function edited(document, code) {
  return { ...document, text: withCode(document.text, document.node, code) };
}

/**
 * @param {Document} document
 * @param {"event" | "constant"} kind
 * @param {string} name
 * @param {number | null} value
 * @returns {Document}
 */
export function redefined(document, kind, name, value) {
  return { ...document, text: withEntry(document.text, kind, name, value) };
}

/** Whether it has changes that no file and no robot has. @param {Document} document */
export function isUnsaved({ text, saved }) {
  return text !== saved;
}

/** Whether the robot runs just this. @param {Document} document */
export function isInRobot({ text, loaded }) {
  return text === loaded;
}

/** A name that a file can have. @param {string} name */
export function fileName(name) {
  const clean = name.replace(/^.*[/\\]/, "").replace(/[<>:"|?*\u0000-\u001f]/g, "_");
  return /\.aesl$/i.test(clean) ? clean : `${clean.replace(/\.(aseba|txt)$/i, "") || "program"}.aesl`;
}
