// Recognizes files of other programs by their content, as aseba_vm/aesl/foreign_files.py does with the same expressions.

import { translator } from "../i18n/index.js";
import data from "./foreign_kinds.texts.js";
import { decoded } from "./text_file.js";

/** Characters or bytes at each end of a file that are searched. */
const HEAD = 20_000;
const PROLOGUE = /^(?:\s+|<\?[^>]*>|<!--[\s\S]*?-->)*/;
/** @typedef {[kind: string, pattern: string]} Kind */
/** @typedef {{ bytes: Kind[], xml: Kind[], json: [kind: string, patterns: string[]][], code: Record<string, string>, network: string }} Kinds */
const { bytes, xml, json, code, network } = /** @type {Kinds} */ (data.kinds);
const BYTES = bytes.map(([kind, pattern]) => ({ kind, pattern: new RegExp(`^(?:${pattern})`, "s") }));
const XML = xml.map(([kind, pattern]) => ({ kind, pattern: new RegExp(`^(?:${pattern})`, "i") }));
const JSON_TEXT = json.map(([kind, patterns]) => ({ kind, patterns: patterns.map((each) => new RegExp(each)) }));
const NETWORK = new RegExp(`^(?:${network})`);
const { imports, python, aseba, ros, tdmclient } = Object.fromEntries(
  Object.entries(code).map(([name, pattern]) => [name, new RegExp(pattern, "m")]),
);
const COMMENTS = new RegExp(code.comments, "gs");

/**
 * What another program's file is: the end of the key of its sentence, or "program" for an .aesl file; empty: neither.
 *
 * @param {Uint8Array} content
 */
export function kindOf(content) {
  const ends = content.length <= 2 * HEAD ? [content] : [content.subarray(0, HEAD), content.subarray(-HEAD)];
  const letters = ends.map(lettersOf).join("");
  const binary = BYTES.find(({ pattern }) => pattern.test(letters));
  if (binary !== undefined) return binary.kind;
  try {
    return kindOfText(decoded(content).slice(0, HEAD).replace(/^\uFEFF/, ""));
  } catch {
    return ""; // no text: refused as such
  }
}

/** The sentence about a kind of file. @param {string} kind @param {string} language */
export const sentenceOf = (kind, language) => translator(language, data.sentences)(`foreign-${kind}`);

/** @param {string} text */
function kindOfText(text) {
  const begin = text.trimStart()[0];
  if (begin === "<") {
    const root = text.replace(PROLOGUE, "");
    return NETWORK.test(root) ? "program" : (XML.find(({ pattern }) => pattern.test(root))?.kind ?? "");
  }
  if (begin === "{" || begin === "[") {
    return JSON_TEXT.find(({ patterns }) => patterns.every((each) => each.test(text)))?.kind ?? "";
  }
  const bare = text.replace(COMMENTS, "");
  const hasImport = imports.test(bare);
  if (ros.test(bare) && (hasImport || bare.includes("#include"))) return "ros";
  if (hasImport || (python.test(bare) && !aseba.test(bare))) return tdmclient.test(bare) ? "tdmclient" : "python";
  return "";
}

/** A letter for each byte. @param {Uint8Array} content */
function lettersOf(content) {
  let text = "";
  for (const byte of content) text += String.fromCharCode(byte);
  return text;
}
