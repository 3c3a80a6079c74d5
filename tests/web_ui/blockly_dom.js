// Blockly without a browser: it keeps the shadows of a workspace as XML elements, so it needs a few of their methods.

import { createRequire } from "node:module";

class FakeElement {
  /** @param {string} name */
  constructor(name) {
    this.nodeName = name;
    this.tagName = name;
    this.nodeType = 1;
    /** @type {Map<string, string>} */ this.attributes = new Map();
    /** @type {any[]} */ this.childNodes = [];
    /** @type {FakeElement | null} */ this.parentNode = null;
  }

  /** @param {string} name @param {unknown} value */
  setAttribute(name, value) {
    this.attributes.set(name, String(value));
  }

  /** @param {string} name */
  getAttribute(name) {
    return this.attributes.get(name) ?? null;
  }

  /** @param {string} name */
  hasAttribute(name) {
    return this.attributes.has(name);
  }

  /** @param {string} name */
  removeAttribute(name) {
    this.attributes.delete(name);
  }

  /** @param {any} child */
  appendChild(child) {
    child.parentNode = this;
    this.childNodes.push(child);
    return child;
  }

  /** @param {boolean} deep */
  cloneNode(deep) {
    const copy = new FakeElement(this.nodeName);
    for (const [name, value] of this.attributes) copy.setAttribute(name, value);
    if (deep) for (const child of this.childNodes) copy.appendChild(child.cloneNode(true));
    return copy;
  }

  /** @returns {string} */
  get textContent() {
    return this.childNodes.map((child) => child.textContent).join("");
  }

  set textContent(text) {
    this.childNodes = [new FakeText(text)];
  }

  get firstChild() {
    return this.childNodes[0] ?? null;
  }
}

class FakeText {
  /** @param {string} text */
  constructor(text) {
    this.nodeName = "#text";
    this.nodeType = 3;
    this.textContent = text;
    this.parentNode = null;
  }

  cloneNode() {
    return new FakeText(this.textContent);
  }
}

const document = {
  createElementNS: (/** @type {string} */ _namespace, /** @type {string} */ name) => new FakeElement(name),
  createTextNode: (/** @type {string} */ text) => new FakeText(text),
};

const require = createRequire(new URL("../../web_ui/", import.meta.url));
const folder = new URL("../../web_ui/node_modules/", import.meta.url).pathname;

/** Blockly with its own blocks. @type {any} */
export const Blockly = require(`${folder}blockly/blockly_compressed.js`);
require(`${folder}blockly/blocks_compressed.js`);
/** Its English texts. @type {Record<string, string>} */
export const ENGLISH = require(`${folder}blockly/msg/en.js`);
Blockly.utils.xml.injectDependencies({ document, DOMParser: class {}, XMLSerializer: class {} });
Blockly.setLocale(require(`${folder}blockly/msg/en.js`));
Blockly.Events.disable(); // they are sent later, on a timer
