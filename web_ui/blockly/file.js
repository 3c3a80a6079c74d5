// Blockly programs in files: .aesl files with a workspace in them, and files that are a workspace only.
// A file is kept as text; writing replaces the workspace and the code only where they have changed.

import { AeslError, newAesl, readAesl, withCode } from "../editor/aesl.js";
import { readWorkspace } from "./read_workspace.js";
import { emptyState, sameWorkspace } from "./state.js";
import { ROOT, writeWorkspace } from "./write_workspace.js";
import { childrenOf, readXml } from "./xml_tree.js";

/** @typedef {import("./xml_tree.js").Element} Element */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("./read_workspace.js").FileProblem} FileProblem */
/**
 * @typedef {object} BlocklyFile
 * @property {string} text
 * @property {"aesl" | "xml"} kind
 * @property {number} node          index of the node with the workspace
 * @property {string | null} code   the stored program of the node; null in a file without one
 * @property {boolean} hasWorkspace
 * @property {WorkspaceState} state
 * @property {FileProblem[]} problems  with an error among them, the file can be run but not edited as blocks
 */

const PLUGIN = "ThymioBlockly";
const PLUGINS = "toolsPlugins";

/**
 * Read a file. It never throws: what is wrong is in `problems`.
 *
 * @param {string} text
 * @returns {BlocklyFile}
 */
export function readFile(text) {
  /** @type {BlocklyFile} */
  const file = { text, kind: "aesl", node: 0, code: null, hasWorkspace: false, state: emptyState(), problems: [] };
  try {
    const root = readXml(text);
    if (root.name === "xml") file.kind = "xml";
    else file.code = readAesl(text).nodes[0]?.code ?? "";
    const place = find(root);
    if (place === null) return file;
    const { xml, node } = place;
    if (file.kind === "aesl") file.code = readAesl(text).nodes[node].code;
    return { ...file, node, hasWorkspace: true, ...readWorkspace(text, xml) };
  } catch (error) {
    if (error instanceof AeslError) {
      const { line, column, message } = error;
      return { ...file, problems: [{ severity: "error", key: "notXml", values: { message }, line, column }] };
    }
    // thousands of elements inside each other
    if (error instanceof RangeError) {
      return { ...file, problems: [{ severity: "error", key: "tooDeep", values: {}, line: 1, column: 1 }] };
    }
    throw error;
  }
}

/**
 * The text of a file with another workspace, byte for byte the same where nothing has changed.
 *
 * @param {BlocklyFile} file
 * @param {WorkspaceState} state
 * @param {string | null} [code]  the program to store; null keeps the stored one
 */
export function writeFile(file, state, code = null) {
  const text = sameWorkspace(file.state, state) ? file.text : withWorkspace(file, state);
  return code === null || file.kind === "xml" ? text : withCode(text, file.node, code);
}

/** A new .aesl file: with a workspace even if it is empty. @param {WorkspaceState} state @param {string} code */
export function newFile(state, code) {
  return withWorkspace(readFile(newAesl(code)), state);
}

/** The file without its blocks: a program as text. @param {string} text */
export function withoutBlocks(text) {
  const root = readXml(text);
  const place = find(root);
  return place === null || root.name === "xml" ? text : withoutWorkspace(text, childrenOf(root, "node")[place.node]);
}

/**
 * @param {Element} root
 * @returns {{ xml: Element, node: number } | null} the first workspace and the index of its node
 */
function find(root) {
  if (root.name === "xml") return { xml: root, node: 0 };
  for (const [node, element] of childrenOf(root, "node").entries()) {
    const plugins = childrenOf(element, PLUGINS).flatMap((each) => childrenOf(each, PLUGIN));
    const xml = plugins.flatMap((each) => childrenOf(each, "xml")).at(0);
    if (xml !== undefined) return { xml, node };
  }
  return null;
}

/** @param {BlocklyFile} file @param {WorkspaceState} state */
function withWorkspace({ text, node }, state) {
  const newline = /\r\n/.test(text) ? "\r\n" : "\n";
  const root = readXml(text);
  const place = find(root);
  if (place !== null) {
    const { xml } = place;
    const tag = xml.empty ? text.slice(xml.from, xml.to).replace(/\s*\/>$/, ">") : text.slice(xml.from, xml.inner);
    const indent = indentAt(text, xml.from);
    return text.slice(0, xml.from) + writeWorkspace(state, { root: tag, indent, newline }) + text.slice(xml.to);
  }
  const element = childrenOf(root, "node").at(node);
  if (element === undefined) throw new AeslError(text, root.from, "found no <node>, expected one");
  return withNewWorkspace(text, element, state, newline);
}

/** @param {string} text @param {Element} node @param {WorkspaceState} state @param {string} newline */
function withNewWorkspace(text, node, state, newline) {
  const xml = writeWorkspace(state, { root: ROOT, indent: "    ", newline });
  const plugin = [`   <${PLUGIN}>`, `    ${xml}`, `   </${PLUGIN}>`].join(newline);
  const [plugins] = childrenOf(node, PLUGINS);
  if (plugins !== undefined && !plugins.empty) {
    return `${text.slice(0, plugins.outer).trimEnd()}${newline}${plugin}${newline}  ${text.slice(plugins.outer)}`;
  }
  const all = [`<${PLUGINS}>`, plugin, `  </${PLUGINS}>`].join(newline);
  if (plugins !== undefined) return text.slice(0, plugins.from) + all + text.slice(plugins.to);
  if (!node.empty) return `${text.slice(0, node.outer)}${all}${text.slice(node.outer)}`;
  const open = text.slice(node.from, node.to).replace(/\s*\/>$/, ">");
  return `${text.slice(0, node.from)}${open}${all}</node>${text.slice(node.to)}`;
}

/**
 * Without the workspace, and without the list of plug-ins if nothing else is in it.
 *
 * @param {string} text
 * @param {Element} node
 */
function withoutWorkspace(text, node) {
  const [plugins] = childrenOf(node, PLUGINS);
  const [plugin] = childrenOf(plugins, PLUGIN);
  const { from, to } = plugins.children.length === 1 ? plugins : plugin;
  return text.slice(0, from) + text.slice(to);
}

/**
 * The blanks in front of a position, if nothing else is before it in its line.
 *
 * @param {string} text
 * @param {number} at
 */
function indentAt(text, at) {
  return /(?:^|[\r\n])([ \t]*)$/.exec(text.slice(0, at))?.[1] ?? "";
}
