// Reads the workspace XML of old and new Blockly. Nothing is skipped silently: what the editor cannot show is a
// problem, and a file with an error is not opened for editing, so that nothing of it can get lost.

import { BLOCKS } from "./blocks/index.js";
import { CALL, DEFINITIONS } from "./blocks/variables.js";
import { childrenOf, lineAndColumn } from "./xml_tree.js";

/** @typedef {import("./xml_tree.js").Element} Element */
/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("./state.js").Socket} Socket */
/** @typedef {import("./blocks/spec.js").Arg} Arg */
/**
 * @typedef {object} FileProblem
 * @property {"error" | "warning"} severity
 * @property {string} key  of `file.<key>` in the texts
 * @property {Record<string, string | number>} values
 * @property {number} line    from 1
 * @property {number} column  from 1
 */

/**
 * Attribute of a block → whether the state has it if it is "true", or if it is "false".
 *
 * @type {Record<string, boolean>}
 */
const FLAGS = { collapsed: true, deletable: false, movable: false, editable: false };
const DISABLED = "MANUALLY_DISABLED";

/**
 * The workspace in an <xml> element.
 *
 * @param {string} text  of the file, for positions
 * @param {Element} xml
 * @returns {{ state: WorkspaceState, problems: FileProblem[] }}
 */
export function readWorkspace(text, xml) {
  const reader = new Reader(text);
  reader.readVariables(xml);
  const blocks = xml.children.flatMap((child) => {
    if (["block", "shadow"].includes(child.name)) return [reader.top(child)];
    if (!["variables", "comment"].includes(child.name)) reader.report(child, "unknownElement", { found: child.name });
    return [];
  });
  /** @type {WorkspaceState} */
  const state = { blocks: { languageVersion: 0, blocks }, variables: [...reader.variables.values()] };
  const comments = childrenOf(xml, "comment").map(({ text: content, attributes: { x, y, w, h } }) => ({
    text: content,
    x: numberOf(x),
    y: numberOf(y),
    width: numberOf(w),
    height: numberOf(h),
  }));
  if (comments.length > 0) state.workspaceComments = comments;
  return { state, problems: reader.problems };
}

/** @type {Arg} */
const BODY = { kind: "body", name: "" };
/** The branches of an "if" are as many as its mutation says. */
const BRANCHES = /^(IF|DO)\d+$/;

/** @param {BlockState} block @param {string} name @returns {Arg | undefined} */
function argOf({ type }, name) {
  const known = type === "controls_if" ? name.replace(BRANCHES, "$10") : name;
  return BLOCKS.get(type)?.args.find((arg) => arg.name === known && ["value", "body"].includes(arg.kind));
}

/** The name that a block has today for an argument of a file. @param {BlockState} block @param {string} found */
function currentName({ type }, found) {
  return BLOCKS.get(type)?.args.find(({ former }) => former === found)?.name ?? found;
}

/** @param {string | undefined} value @returns {number | undefined} */
const numberOf = (value) => (value === undefined || !Number.isFinite(Number(value)) ? undefined : Number(value));

class Reader {
  /** @param {string} text */
  constructor(text) {
    this.text = text;
    /** @type {FileProblem[]} */ this.problems = [];
    /**
     * Lower-case name → variable: names that differ only in case are the same.
     *
     * @type {Map<string, import("./state.js").Variable>}
     */
    this.variables = new Map();
    /** @type {Set<string>} */ this.ids = new Set();
  }

  /** @param {Element} element @param {string} key @param {Record<string, string | number>} values */
  report(element, key, values) {
    this.problems.push({ severity: "error", key, values, ...lineAndColumn(this.text, element.from) });
  }

  /** @param {Element} xml */
  readVariables(xml) {
    for (const list of childrenOf(xml, "variables")) {
      for (const { text: name, attributes } of childrenOf(list, "variable")) this.#variable(name, attributes.id);
    }
  }

  /** @param {Element} element @returns {BlockState} */
  top(element) {
    const block = this.#block(element);
    const { x, y } = element.attributes;
    return { ...block, x: numberOf(x) ?? 0, y: numberOf(y) ?? 0 };
  }

  /** @param {Element} element @returns {BlockState} */
  #block(element) {
    const { type = "" } = element.attributes;
    /** @type {BlockState} */ const block = { type, id: this.#id(element.attributes.id) };
    if (!BLOCKS.has(type)) this.report(element, "unknownBlock", { type });
    this.#readFlags(element, block);
    for (const child of element.children) this.#readChild(child, block);
    this.#checkBranches(element, block);
    return block;
  }

  /** @param {Element} element @param {BlockState} block */
  #readFlags({ attributes }, block) {
    for (const [name, stated] of Object.entries(FLAGS)) {
      if (attributes[name] === String(stated)) Object.assign(block, { [name]: stated });
    }
    if (attributes.inline !== undefined) block.inline = attributes.inline === "true";
    const reasons = attributes["disabled-reasons"];
    if (reasons) block.disabledReasons = reasons.split(",").map(decodeURIComponent);
    else if (attributes.disabled === "true") block.disabledReasons = [DISABLED];
  }

  /** @param {Element} child @param {BlockState} block */
  #readChild(child, block) {
    const name = currentName(block, child.attributes.name ?? "");
    switch (child.name) {
      case "field":
      case "title": // of the oldest files
        (block.fields ??= {})[name] = this.#field(child, block, name);
        break;
      case "value":
      case "statement":
        this.#checkInput(child, block, name);
        (block.inputs ??= {})[name] = this.#socket(child, argOf(block, name));
        break;
      case "next":
        if (BLOCKS.get(block.type)?.trigger === undefined) this.#checkPlace(child, block.type, BODY);
        block.next = this.#socket(child, BODY);
        break;
      case "mutation":
        this.#readMutation(child, block);
        break;
      case "comment": {
        const { pinned, h, w } = child.attributes;
        const size = { height: numberOf(h), width: numberOf(w) };
        block.icons = { comment: { text: child.text, pinned: pinned === "true", ...size } };
        break;
      }
      case "data":
        block.data = child.text;
        break;
      default:
        this.report(child, "unknownElement", { found: child.name });
    }
  }

  /** @param {Element} element @param {Arg | undefined} arg @returns {Socket} */
  #socket(element, arg) {
    /** @type {Socket} */ const socket = {};
    for (const child of element.children) {
      if (child.name === "block" || child.name === "shadow") {
        socket[child.name] = this.#block(child);
        if (arg !== undefined) this.#checkPlace(child, child.attributes.type ?? "", arg);
      } else this.report(child, "unknownElement", { found: child.name });
    }
    return socket;
  }

  /**
   * Whether a block fits where it is: Blockly would refuse the whole workspace.
   *
   * @param {Element} element
   * @param {string} type
   * @param {Arg} arg
   */
  #checkPlace(element, type, { kind, check }) {
    const spec = BLOCKS.get(type);
    if (spec === undefined) return;
    const { shape, anywhere = false } = spec;
    const isValue = shape === "Number" || shape === "Boolean";
    const fits = kind === "body" ? shape === "statement" : isValue && (anywhere || !check || check === shape);
    if (!fits) this.report(element, "wrongPlace", { type });
  }

  /** @param {Element} element @param {BlockState} block @param {string} name @returns {any} */
  #field(element, block, name) {
    const { text } = element;
    const spec = BLOCKS.get(block.type);
    const arg = spec?.args.find((each) => each.name === name);
    if (arg === undefined) {
      if (spec !== undefined) this.report(element, "unknownField", { type: block.type, field: name });
      return text;
    }
    return this.#fieldValue(element, arg);
  }

  /** @param {Element} element @param {Arg} arg @returns {any} */
  #fieldValue(element, { kind, name, options = [] }) {
    const { text } = element;
    if (kind === "variable") return { id: this.#variable(text, element.attributes.id).id };
    if (kind === "choice" && !options.some(([, value]) => value === text)) {
      const expected = options.map(([, value]) => value).join(", ");
      this.report(element, "unknownOption", { field: name, found: text, expected });
    }
    if (kind === "integer") {
      const number = Number(text);
      if (text.trim() !== "" && Number.isFinite(number)) return number;
      this.report(element, "notANumber", { field: name, found: text });
    }
    if (kind === "color" && !/^#[0-9a-f]{6}$/i.test(text))
      this.report(element, "notAColor", { field: name, found: text });
    return text;
  }

  /** @param {Element} element @param {BlockState} block @param {string} name */
  #checkInput(element, block, name) {
    if (!BLOCKS.has(block.type) || argOf(block, name) !== undefined) return;
    this.report(element, "unknownInput", { type: block.type, input: name });
  }

  /** @param {Element} mutation @param {BlockState} block */
  #readMutation(mutation, block) {
    const { attributes } = mutation;
    const params = childrenOf(mutation, "arg").map((arg) => arg.attributes.name ?? "");
    if (block.type === "controls_if") {
      const elseIfCount = numberOf(attributes.elseif) ?? 0;
      const hasElse = (numberOf(attributes.else) ?? 0) > 0;
      block.extraState = { ...(elseIfCount > 0 ? { elseIfCount } : {}), ...(hasElse ? { hasElse } : {}) };
    } else if (block.type === CALL) {
      block.extraState = { name: attributes.name ?? "", ...(params.length > 0 ? { params } : {}) };
    } else if (DEFINITIONS.includes(block.type)) {
      if (params.length > 0) this.report(mutation, "parameters", { found: params.join(", ") });
    } else if (BLOCKS.has(block.type)) {
      this.report(mutation, "unknownElement", { found: "mutation" });
    }
  }

  /**
   * An "if" whose branches are not counted in its mutation gets the count.
   *
   * @param {Element} element
   * @param {BlockState} block
   */
  #checkBranches(element, block) {
    if (block.type !== "controls_if") return;
    const names = Object.keys(block.inputs ?? {});
    const indices = names.flatMap((name) => /^(?:IF|DO)(\d+)$/.exec(name)?.[1] ?? []).map(Number);
    const elseIfCount = Math.max(block.extraState?.elseIfCount ?? 0, 0, ...indices);
    const hasElse = block.extraState?.hasElse === true || names.includes("ELSE");
    if (elseIfCount > 100) this.report(element, "tooManyBranches", { found: elseIfCount, most: 100 });
    delete block.extraState;
    if (elseIfCount > 0 || hasElse) {
      block.extraState = { ...(elseIfCount > 0 ? { elseIfCount } : {}), ...(hasElse ? { hasElse } : {}) };
    }
  }

  /** @param {string} name @param {string | undefined} id */
  #variable(name, id) {
    const key = name.toLowerCase();
    const known = this.variables.get(key);
    if (known !== undefined) return known;
    const variable = { id: this.#id(id, "v"), name };
    this.variables.set(key, variable);
    return variable;
  }

  /** The id of a file, else a new one; ids are unique. @param {string | undefined} wanted @param {string} [letter] */
  #id(wanted, letter = "b") {
    let id = wanted ?? "";
    for (let number = this.ids.size + 1; id === "" || this.ids.has(id); number++) id = `${letter}${number}`;
    this.ids.add(id);
    return id;
  }
}
