// The elements of the VPL part of a file as a tree, with their places in the file.

import { attributesOf, scan } from "../editor/xml.js";

/**
 * @typedef {object} Element
 * @property {string} name
 * @property {Record<string, string>} attributes
 * @property {Element[]} children
 * @property {number} from  start in the text of the file
 * @property {number} to    end in it
 */

/**
 * The root element of a text, as a tree. Throws AeslError if it is not XML.
 *
 * @param {string} text
 * @returns {Element}
 */
export function readElements(text) {
  /** @type {Element} */ const document = { name: "", attributes: {}, children: [], from: 0, to: text.length };
  const open = [document];
  for (const part of scan(text)) {
    if (part.kind === "open") {
      const found = Object.entries(attributesOf(text, part)).map(([name, { value }]) => [name, value]);
      /** @type {Element} */
      const element = {
        name: part.name,
        attributes: Object.fromEntries(found),
        children: [],
        from: part.from,
        to: part.to,
      };
      open[open.length - 1].children.push(element);
      if (!part.closed) open.push(element);
    } else if (part.kind === "close") {
      const closed = open.pop();
      if (closed !== undefined) closed.to = part.to;
    }
  }
  return document;
}

/**
 * The last element with one of these names within another one, in the order of the text.
 *
 * @param {Element} element
 * @param {string[]} names
 * @returns {Element | null}
 */
export function lastOf(element, names) {
  for (const child of [...element.children].reverse()) {
    const found = names.includes(child.name) ? child : lastOf(child, names);
    if (found !== null) return found;
  }
  return null;
}

/** Line and column of a place, from 1. @param {string} text @param {number} at */
export function placeOf(text, at) {
  const before = text.slice(0, at).split(/\r\n|\r|\n/);
  return { line: before.length, column: 1 + before[before.length - 1].length };
}

/** The number of a text, null if it is none. @param {string} text */
export function wholeNumber(text) {
  return /^\s*[+-]?\d+\s*$/.test(text) ? Number(text) : null;
}
