// VPL programs in .aesl files: open one, and write changes into it; everything else in the file stays byte for byte.

import { AeslError, newAesl, readAesl, withCode, withEntry } from "../editor/aesl.js";
import { encoded } from "../editor/xml.js";
import { lastOf, placeOf, readElements } from "./elements.js";
import { VplError } from "./errors.js";
import { REPORTS } from "./generator.js";
import { makeProgram, sameProgram } from "./program.js";
import { readPairs } from "./read_pairs.js";
import { readSets } from "./read_sets.js";
import { writeSets } from "./write_sets.js";

/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("./program.js").Program} Program */
/**
 * @typedef {object} VplFile
 * @property {string} text          the whole file
 * @property {number} node          index of the node with the VPL program
 * @property {string} code          its Aseba text, which is what the robot runs
 * @property {0 | 1} format
 * @property {Program} program
 * @property {Program} stored       the rows as they are stored: format 0 has one action in each
 * @property {Finding[]} warnings   what could not be read as it is written
 */

const ROOT = "vplroot";
const FORMAT = "xml-format-version";

/**
 * Open a file with a VPL program; with several, the last one counts. Throws VplError.
 *
 * @param {string} text
 * @returns {VplFile}
 */
export function readVpl(text) {
  const { aesl, document } = parsed(text);
  const nodes = document.children.flatMap(({ children }) => children).filter(({ name }) => name === "node");
  const roots = nodes.map((node) => lastOf(node, ROOT));
  const root = [...roots].reverse().find((each) => each !== null) ?? null;
  if (root === null) throw new VplError("file.none");
  const node = roots.indexOf(root);
  const code = aesl.nodes[node].code;
  const format = root.attributes[FORMAT];
  if (format === undefined) {
    const { program, pairs, warnings } = readPairs(root, text);
    return { text, node, code, format: 0, program, stored: pairs, warnings };
  }
  const { program, warnings } = readSets(root, text);
  if (format !== "1") warnings.unshift({ key: "load.format", values: { ...placeOf(text, root.from), found: format } });
  return { text, node, code, format: 1, program, stored: program, warnings };
}

/**
 * The file with another program and text. Without changes it is the file itself.
 *
 * @param {VplFile} file
 * @param {Program} program
 * @param {string} code  that of `generate`, or `file.code` if the program has an error or its text is to be kept
 */
export function writeVpl(file, program, code) {
  let { text } = file;
  if (!sameProgram(program, file.program)) {
    const root = rootOf(text, file.node);
    text =
      text.slice(0, root.from) + writeSets(program, marginAt(text, root.from), newlineOf(text)) + text.slice(root.to);
  }
  if (code.trimEnd() === file.code.trimEnd()) return text;
  return withReport(withNodeCode(text, file.node, code), code);
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
 * A new file for one Thymio.
 *
 * @param {Program} [program]
 * @param {string} [code]
 */
export function newVpl(program = makeProgram(false), code = "") {
  const plugin = [
    "<toolsPlugins>",
    " <ThymioVisualProgramming>",
    `  ${writeSets(program, "  ")}`,
    " </ThymioVisualProgramming>",
  ];
  const text = newAesl(code);
  const end = text.lastIndexOf("</node>");
  return withReport(`${text.slice(0, end)}${plugin.join("\n")}\n</toolsPlugins>\n${text.slice(end)}`, code);
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
    if (error instanceof AeslError)
      throw new VplError("file.xml", { line: error.line, column: error.column, what: error.message });
    throw error;
  }
}

/** @param {string} text @param {number} index */
function rootOf(text, index) {
  const nodes = readElements(text)
    .children.flatMap(({ children }) => children)
    .filter(({ name }) => name === "node");
  const root = lastOf(nodes[index], ROOT);
  if (root === null)
    throw new RangeError(`node ${index}: found no <${ROOT}>, expected that of the file that was opened`);
  return root;
}

/** White space at the start of the line of a place. @param {string} text @param {number} at */
function marginAt(text, at) {
  return /(?:^|\n)([ \t]*)$/.exec(text.slice(0, at))?.[1] ?? "";
}

/** @param {string} text */
const newlineOf = (text) => (text.includes("\r\n") ? "\r\n" : "\n");
