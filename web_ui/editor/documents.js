// One edited program: a whole .aesl file and the node whose code is shown, or a file of Python. Immutable values, no DOM.

import { isPython } from "../browser/python_name.js";
import { looksLikeAesl, newAesl, readAesl, withCode, withEntry, withLast } from "./aesl.js";

/**
 * @typedef {object} Document
 * @property {string} name
 * @property {string} text            content of the file as it would be saved
 * @property {number} node            index of the node that is shown
 * @property {string} saved           text when last opened, saved or read from a robot
 * @property {string | null} loaded   text when last loaded into or read from a robot; null: never
 * @property {string | null} source   the robot's source from which it was read or which was loaded
 * @property {boolean} own            whether the user created or opened it
 */

export const UNTITLED = "program.aesl";

/** @param {string} [name] @returns {Document} */
export function blank(name = UNTITLED) {
  const text = isPython(name) ? "" : newAesl();
  return { name, text, node: 0, saved: text, loaded: null, source: null, own: false };
}

/**
 * A document from a file or a bare program. Throws AeslError if it is not a valid .aesl file.
 *
 * @param {string} name
 * @param {string} text
 * @returns {Document}
 */
export function opened(name, text) {
  if (isPython(name)) {
    const plain = text.replace(/^\uFEFF/, "").replaceAll("\r\n", "\n");
    return { name, text: plain, node: 0, saved: plain, loaded: null, source: null, own: true };
  }
  const wrapped = looksLikeAesl(text) ? text : newAesl(text.replaceAll("\r\n", "\n"));
  const { nodes } = readAesl(wrapped);
  const whole =
    nodes.length > 0
      ? wrapped
      : withLast(wrapped, '<node nodeId="1" name="thymio-II"></node>\n');
  return { name: name || UNTITLED, text: whole, node: 0, saved: whole, loaded: null, source: null, own: true };
}

/**
 * A document from the program of a robot.
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
export function codeOf({ name, text, node }) {
  return isPython(name) ? text : readAesl(text).nodes[node].code;
}

/** @param {Document} document @param {string} code @returns {Document} */
export function edited(document, code) {
  if (isPython(document.name)) return { ...document, text: code };
  return { ...document, text: withCode(document.text, document.node, code) };
}

/** The document with another text of the whole file. @param {Document} document @param {string} text @returns {Document} */
export function rewritten(document, text) {
  if (isPython(document.name)) return { ...document, text };
  return { ...document, text, node: Math.min(document.node, Math.max(readAesl(text).nodes.length - 1, 0)) };
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

/** Whether there are changes that neither a file nor a robot has. @param {Document} document */
export function isUnsaved({ text, saved }) {
  return text !== saved;
}

/** Whether the robot runs exactly this text. @param {Document} document */
export function isInRobot({ text, loaded }) {
  return text === loaded;
}

/** Convert a name to a valid file name. @param {string} name */
export function fileName(name) {
  const clean = name.replace(/^.*[/\\]/, "").replace(/[<>:"|?*\u0000-\u001f]/g, "_");
  return /\.aesl$/i.test(clean) || isPython(clean) ? clean : `${clean.replace(/\.(aseba|txt)$/i, "") || "program"}.aesl`;
}
