// Writes workspace XML in the old form, which all programs read: no ids, variables by name, no list of variables.

import { BLOCKS } from "./blocks/index.js";
import { CALL, subroutineName } from "./blocks/variables.js";
import { isDisabled, topBlocks, variableName } from "./state.js";
import { escaped } from "./xml_tree.js";

/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./state.js").Socket} Socket */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */

/** How the page of Thymio Blockly writes the root. */
export const ROOT = '<xml xmlns="http://www.w3.org/1999/xhtml">';
const INDENT = "  ";

/**
 * @param {WorkspaceState} state
 * @param {{ root?: string, indent?: string, newline?: string }} [options]  `root` is the opening tag
 */
export function writeWorkspace(state, { root = ROOT, indent = "", newline = "\n" } = {}) {
  const comments = (state.workspaceComments ?? []).map(({ text = "", x, y, width, height }) => {
    const attributes = attributesText({ x, y, h: height, w: width });
    return `${INDENT}<comment${attributes}>${escaped(text)}</comment>`;
  });
  const blocks = topBlocks(state).flatMap((block) => new Writer(state).block("block", block, true).map(inward));
  return [root, ...comments, ...blocks, "</xml>"]
    .map((line, index) => (index === 0 ? line : indent + line))
    .join(newline);
}

/** @param {string} line */
const inward = (line) => INDENT + line;

/** @param {Record<string, string | number | boolean | undefined>} attributes */
function attributesText(attributes) {
  const stated = Object.entries(attributes).filter(([, value]) => value !== undefined);
  return stated.map(([name, value]) => ` ${name}="${escaped(String(value))}"`).join("");
}

class Writer {
  /** @param {WorkspaceState} state */
  constructor(state) {
    this.state = state;
  }

  /** @param {"block" | "shadow"} tag @param {BlockState} block @param {boolean} [atTop] @returns {string[]} */
  block(tag, block, atTop = false) {
    const lines = [
      ...this.#mutation(block),
      ...Object.entries(block.fields ?? {}).map(([name, value]) => this.#field(name, value)),
      ...this.#comment(block),
      ...(block.data === undefined ? [] : [`<data>${escaped(block.data)}</data>`]),
      ...Object.entries(block.inputs ?? {}).flatMap(([name, socket]) => this.#input(block, name, socket)),
      ...(block.next === undefined ? [] : this.#element("next", "", block.next)),
    ];
    const start = `<${tag}${this.#attributes(block, atTop)}`;
    return lines.length === 0 ? [`${start}></${tag}>`] : [`${start}>`, ...lines.map(inward), `</${tag}>`];
  }

  /** @param {BlockState} block @param {boolean} atTop */
  #attributes(block, atTop) {
    const { type, collapsed, deletable, movable, editable, inline } = block;
    /** @param {boolean | undefined} value @param {boolean} written */
    const only = (value, written) => (value === written ? value : undefined);
    const place = atTop ? { x: Math.round(block.x ?? 0), y: Math.round(block.y ?? 0) } : {};
    return attributesText({
      type,
      inline,
      collapsed: only(collapsed, true),
      disabled: isDisabled(block) ? true : undefined,
      deletable: only(deletable, false),
      movable: only(movable, false),
      editable: only(editable, false),
      ...place,
    });
  }

  /** @param {BlockState} block @returns {string[]} */
  #mutation(block) {
    const { type, extraState } = block;
    if (type === CALL) return [`<mutation${attributesText({ name: subroutineName(block) })}></mutation>`];
    if (type !== "controls_if" || !extraState) return [];
    const attributes = { elseif: extraState.elseIfCount || undefined, else: extraState.hasElse ? 1 : undefined };
    return [`<mutation${attributesText(attributes)}></mutation>`];
  }

  /** @param {string} name @param {any} value */
  #field(name, value) {
    const text = value !== null && typeof value === "object" ? variableName(this.state, value) : String(value);
    return `<field${attributesText({ name })}>${escaped(text)}</field>`;
  }

  /** @param {BlockState} block @returns {string[]} */
  #comment({ icons }) {
    if (icons?.comment === undefined) return [];
    const { text, pinned = false, height, width } = icons.comment;
    return [`<comment${attributesText({ pinned, h: height, w: width })}>${escaped(text)}</comment>`];
  }

  /** @param {BlockState} block @param {string} name @param {Socket} socket @returns {string[]} */
  #input({ type }, name, socket) {
    const arg = BLOCKS.get(type)?.args.find((each) => each.name === name);
    const isBody = arg?.kind === "body" || /^DO\d+$/.test(name);
    return this.#element(isBody ? "statement" : "value", attributesText({ name }), socket);
  }

  /** @param {string} tag @param {string} attributes @param {Socket} socket @returns {string[]} */
  #element(tag, attributes, { block, shadow }) {
    const inner = [
      ...(shadow === undefined ? [] : this.block("shadow", shadow)),
      ...(block === undefined ? [] : this.block("block", block)),
    ];
    return inner.length === 0 ? [] : [`<${tag}${attributes}>`, ...inner.map(inward), `</${tag}>`];
  }
}
