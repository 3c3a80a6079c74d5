// VPL programs in .aesl files: open one, and write changes into it; everything else in the file stays byte for byte.

import { AeslError, newAesl, readAesl, REPORTS, withCode, withEntry } from "../editor/aesl.js";
import { encoded } from "../editor/xml.js";
import { lastOf, placeOf, readElements } from "./elements.js";
import { VplError } from "./errors.js";
import { holdsVpl } from "./holds.js";
import { makeProgram, sameProgram } from "./program.js";
import { readPairs } from "./read_pairs.js";
import { readSets } from "./read_sets.js";
import { EXTENDED_ROOT, FORMAT, ROOT, rootName, writeSets } from "./write_sets.js";

/** @typedef {import("./elements.js").Element} Element */
/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */
/**
 * @typedef {object} VplFile
 * @property {string} text          the whole file
 * @property {number} node          index of the node with the VPL program
 * @property {string} code          its Aseba text, which is what the robot runs
 * @property {0 | 1 | "extended"} format
 * @property {Program} program
 * @property {Program} stored       the rows as they are stored: format 0 has one action in each
 * @property {Finding[]} warnings   what could not be read as it is written
 */

/** Element around the program in files of VPL of Aseba. */
const PLUGIN = "ThymioVisualProgramming";

/**
 * Open a file with a VPL program; with several, the last one counts. Throws VplError.
 *
 * @param {string} text
 * @returns {VplFile}
 */
export function readVpl(text) {
  const { aesl, document } = parsed(text);
  const roots = nodesOf(document).map(rootIn);
  const root = [...roots].reverse().find((each) => each !== null) ?? null;
  if (root === null) throw new VplError("file.none");
  const node = roots.indexOf(root);
  const code = aesl.nodes[node].code;
  const format = root.attributes[FORMAT[root.name]];
  if (root.name === ROOT && format === undefined) {
    const { program, pairs, warnings } = readPairs(root, text);
    return { text, node, code, format: 0, program, stored: pairs, warnings };
  }
  const isExtended = root.name === EXTENDED_ROOT;
  const { program, warnings } = readSets(root, text, isExtended);
  const found = format ?? "";
  if (found !== "1") warnings.unshift({ key: "load.format", values: { ...placeOf(text, root.from), found } });
  return { text, node, code, format: isExtended ? "extended" : 1, program, stored: program, warnings };
}

/**
 * The file with another program and text. Without changes it is the file itself.
 *
 * @param {VplFile} file
 * @param {Program} program
 * @param {string} code  that of `generate`, or `file.code` if the program has an error or its text is to be kept
 */
export function writeVpl(file, program, code) {
  const isKept = code.trimEnd() === file.code.trimEnd();
  // The rows of format 0 are not those of a new text.
  const isSame = sameProgram(program, file.program) && (isKept || file.format !== 0);
  const text = isSame ? file.text : withProgram(file, program);
  if (isKept) return text;
  return withReport(withNodeCode(text, file.node, code), code);
}

/**
 * A new file for one Thymio.
 *
 * @param {Program} [program]
 * @param {string} [code]
 */
export function newVpl(program = makeProgram("basic"), code = "") {
  const text = newAesl(code);
  const end = text.lastIndexOf("</node>");
  const plugin = `<toolsPlugins>\n${plugged(program, "", "\n")}\n</toolsPlugins>\n`;
  return withReport(text.slice(0, end) + plugin + text.slice(end), code);
}

/** The element of a file that holds plug-in data. */
const TOOLS = "toolsPlugins";

/** The file without its VPL programs: what is left is text. @param {string} text @returns {string} */
export function withoutVpl(text) {
  const found = nodesOf(readElements(text)).flatMap((node) => {
    const tools = lastOf(node, [TOOLS]);
    const part = lastOf(node, [PLUGIN, EXTENDED_ROOT]) ?? lastOf(node, [ROOT]);
    if (part === null) return [];
    return [tools !== null && tools.children.length === 1 && tools.children[0] === part ? tools : part];
  });
  const result = found.reverse().reduce((left, { from, to }) => {
    const blank = /^[ \t]*\r?\n/.exec(left.slice(to))?.[0].length ?? 0;
    const margin = blank > 0 ? (/[ \t]*$/.exec(left.slice(0, from))?.[0].length ?? 0) : 0;
    return left.slice(0, from - margin) + left.slice(to + blank);
  }, text);
  return found.length > 0 && holdsVpl(result) ? withoutVpl(result) : result;
}

/**
 * The file with another program. An extended program has another element, which VPL of Aseba does not read.
 *
 * @param {VplFile} file
 * @param {Program} program
 */
function withProgram({ text, node: index }, program) {
  const node = nodesOf(readElements(text))[index];
  const root = rootIn(node);
  if (root === null) throw new RangeError(`node ${index}: found no VPL program, expected that of the file`);
  const isSame = root.name === rootName(program);
  const plugin = lastOf(node, [PLUGIN]);
  const old = !isSame && root.name === ROOT && plugin !== null ? plugin : root;
  const margin = /(?:^|\n)([ \t]*)$/.exec(text.slice(0, old.from))?.[1] ?? "";
  const newline = newlineOf(text);
  const element = isSame ? writeSets(program, margin, newline) : plugged(program, margin, newline);
  return text.slice(0, old.from) + element + text.slice(old.to);
}

/**
 * The element of a program, in that of its plug-in.
 *
 * @param {Program} program
 * @param {string} margin
 * @param {string} newline
 */
function plugged(program, margin, newline) {
  if (rootName(program) === EXTENDED_ROOT) return writeSets(program, margin, newline);
  const inner = writeSets(program, `${margin} `, newline);
  return [`<${PLUGIN}>`, ` ${inner}`, `</${PLUGIN}>`].join(`${newline}${margin}`);
}

/**
 * The file with another text of a node. VPL reads a text only if it precedes the elements of the node. White space at
 * the end of the old text, which surrounds those elements, stays.
 *
 * @param {string} text
 * @param {number} index
 * @param {string} code
 */
function withNodeCode(text, index, code) {
  const { tag, code: old } = readAesl(text).nodes[index];
  if (old.trim() !== "") return withCode(text, index, code.trimEnd() + old.slice(old.trimEnd().length));
  return text.slice(0, tag.to) + encoded(code, false, newlineOf(text)) + text.slice(tag.to);
}

/**
 * The file with a declaration of the event that the text emits, so that it compiles everywhere.
 *
 * @param {string} text
 * @param {string} code
 */
function withReport(text, code) {
  const declared = readAesl(text).events.map(({ name }) => name);
  const missing = REPORTS.filter((name) => code.includes(`emit ${name} `) && !declared.includes(name));
  return missing.reduce((result, name) => withEntry(result, "event", name, 1), text);
}

/** @param {string} text */
function parsed(text) {
  try {
    return { aesl: readAesl(text), document: readElements(text) };
  } catch (error) {
    if (!(error instanceof AeslError)) throw error;
    throw new VplError("file.xml", { line: error.line, column: error.column, what: error.message });
  }
}

/** @param {Element} document @returns {Element[]} */
function nodesOf(document) {
  return document.children.flatMap(({ children }) => children).filter(({ name }) => name === "node");
}

/** The element of the program of a node. @param {Element} node */
function rootIn(node) {
  return lastOf(node, [ROOT, EXTENDED_ROOT]);
}

/** @param {string} text */
const newlineOf = (text) => (text.includes("\r\n") ? "\r\n" : "\n");
