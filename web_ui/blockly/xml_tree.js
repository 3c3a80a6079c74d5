// Elements of an XML text with their positions. Names are without prefix: files have the workspace with and without
// namespace.

import { attributesOf, decoded, scan } from "../editor/xml.js";

/**
 * @typedef {object} Element
 * @property {string} name
 * @property {Record<string, string>} attributes
 * @property {Element[]} children
 * @property {string} text   characters of the element itself, not of its children
 * @property {number} from   where its opening tag begins
 * @property {number} inner  where its content begins
 * @property {number} outer  where its closing tag begins
 * @property {number} to     where its closing tag ends
 * @property {boolean} empty whether it is written as <name/>
 */

/**
 * The root element of a text. Throws AeslError if the text is not XML, and for a text without an element.
 *
 * @param {string} text
 * @returns {Element}
 */
export function readXml(text) {
  const document = newElement("", 0, 0);
  const open = [document];
  for (const part of scan(text)) {
    const current = open[open.length - 1];
    if (part.kind === "open") {
      const element = newElement(localName(part.name), part.from, part.to);
      for (const [name, { value }] of Object.entries(attributesOf(text, part))) element.attributes[name] = value;
      current.children.push(element);
      if (part.closed) Object.assign(element, { outer: part.to, to: part.to, empty: true });
      else open.push(element);
    } else if (part.kind === "close") {
      Object.assign(current, { outer: part.from, to: part.to });
      open.pop();
    } else if (part.kind !== "other") {
      for (const { character } of decoded(text, part)) current.text += character;
    }
  }
  const [root] = document.children;
  return root ?? document;
}

/** @param {Element} element @param {string} name */
export const childrenOf = (element, name) => element.children.filter((child) => child.name === name);

/** Line and column of a position, from 1. @param {string} text @param {number} at */
export function lineAndColumn(text, at) {
  const lines = text.slice(0, at).split(/\r\n|\r|\n/);
  return { line: lines.length, column: lines[lines.length - 1].length + 1 };
}

/** @param {string} value */
export const escaped = (value) =>
  value.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;").replaceAll('"', "&quot;");

/** @param {string} name */
const localName = (name) => name.slice(name.indexOf(":") + 1);

/** @param {string} name @param {number} from @param {number} inner @returns {Element} */
function newElement(name, from, inner) {
  return { name, attributes: {}, children: [], text: "", from, inner, outer: inner, to: inner, empty: false };
}
