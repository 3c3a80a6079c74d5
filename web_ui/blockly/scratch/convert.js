// Converts the blocks of a Scratch project. Inputs of project.json are [how, block or primitive, shadow]; a menu is a
// shadow block with one field; a primitive is [kind, value]. Operators and variables become blocks that Blockly
// programs have.

import { BLOCKS } from "../blocks/index.js";
import { numbered, OPERATORS } from "./operators.js";

/** @typedef {import("../state.js").BlockState} BlockState */
/** @typedef {import("../state.js").Socket} Socket */
/** @typedef {import("../state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("../blocks/spec.js").Arg} Arg */
/** @typedef {import("./import_sb3.js").LeftOut} LeftOut */
/**
 * @typedef {object} ScratchBlock
 * @property {string} opcode
 * @property {Record<string, any[]>} [inputs]
 * @property {Record<string, any[]>} [fields]
 * @property {string | null} [next]
 * @property {boolean} [topLevel]
 * @property {boolean} [shadow]
 * @property {number} [x]
 * @property {number} [y]
 */

/** Kinds of primitives. */
const VARIABLE = 12;
const LIST = 13;
const TEXTS = [10, 11];
/** Distance of the stacks of two sprites. */
const SPRITE_GAP = 600;

export class Converter {
  constructor() {
    /** @type {BlockState[]} */
    this.tops = [];
    /** Id in the project, else the name → variable. @type {Map<string, { id: string, name: string }>} */
    this.variables = new Map();
    /** Key and values as JSON → how often. @type {Map<string, { entry: LeftOut, count: number }>} */
    this.missing = new Map();
    /** Id → name and first value of the variables of the project. @type {Map<string, any[]>} */
    this.initial = new Map();
    /** The blocks of the sprite that is read. @type {Record<string, ScratchBlock>} */
    this.blocks = {};
    /** Ids of the blocks that are being converted. @type {Set<string>} */
    this.open = new Set();
    /** In front of the ids of its blocks: sprites may use the same ones. */
    this.prefix = "";
    this.sprites = 0;
  }

  /** All scripts of a sprite or of the stage. @param {any} target */
  add(target) {
    this.blocks = blocksOf(target);
    this.prefix = this.sprites === 0 ? "" : `${this.sprites}.`;
    const tops = Object.entries(this.blocks).filter(([, block]) => block.topLevel && !block.shadow);
    for (const [id, block] of tops) this.#top(id, block);
    for (const [id, variable] of Object.entries(recordOf(target?.variables))) {
      if (Array.isArray(variable)) this.initial.set(id, variable);
    }
    if (tops.length > 0) this.sprites += 1;
  }

  /** @returns {WorkspaceState} */
  state() {
    return { blocks: { languageVersion: 0, blocks: this.tops }, variables: [...this.variables.values()] };
  }

  /** @returns {LeftOut[]} */
  leftOut() {
    // the robot starts with 0 in every variable
    for (const [id, [, value]] of this.initial) {
      const { name } = this.variables.get(id) ?? {};
      if (name !== undefined && Number(value) !== 0) this.leaveOut("leftOutInitial", { name, text: String(value) });
    }
    this.initial.clear();
    return [...this.missing.values()].map(({ entry: { key, values }, count }) => ({
      key,
      values: { ...values, count },
    }));
  }

  /** @param {string} key @param {Record<string, string | number>} [values] */
  leaveOut(key, values = {}) {
    const name = JSON.stringify([key, values]);
    const known = this.missing.get(name);
    if (known === undefined) this.missing.set(name, { entry: { key, values }, count: 1 });
    else known.count += 1;
  }

  /** @param {string} id @param {ScratchBlock} block */
  #top(id, block) {
    const spec = BLOCKS.get(block.opcode);
    if (spec?.trigger === undefined) {
      const isHat = /^event_when|^control_start_as_clone$|^procedures_definition$/.test(block.opcode);
      if (isHat) this.leaveOut("leftOutHat", { opcode: block.opcode });
      else this.leaveOut("leftOutLoose");
      return;
    }
    const [top] = this.chain(id);
    if (top !== undefined)
      this.tops.push({ ...top, x: Math.round(block.x ?? 0) + this.sprites * SPRITE_GAP, y: Math.round(block.y ?? 0) });
  }

  /**
   * A block and those below it as one stack; none or one.
   *
   * @param {string | null | undefined} id
   * @returns {BlockState[]}
   */
  chain(id) {
    /** @type {BlockState[]} */ const stack = [];
    const seen = new Set();
    for (let next = id; typeof next === "string" && !seen.has(next); next = this.blocks[next]?.next) {
      seen.add(next);
      const scratch = this.blocks[next];
      const block = scratch === undefined ? null : this.#block(next, scratch);
      if (block !== null) stack.push(block);
    }
    stack.forEach((block, index) => {
      if (index + 1 < stack.length) block.next = { block: stack[index + 1] };
    });
    return stack.slice(0, 1);
  }

  /** @param {string} id @param {ScratchBlock} scratch @returns {BlockState | null} */
  #block(id, scratch) {
    const { opcode } = scratch;
    if (this.open.has(id)) return null; // a damaged project: a block inside itself
    this.open.add(id);
    const operator = Object.hasOwn(OPERATORS, opcode) ? OPERATORS[opcode] : undefined;
    const block = operator !== undefined ? operator(this, scratch) : this.#ownBlock(scratch);
    this.open.delete(id);
    if (block === null) this.leaveOut("leftOutBlock", { opcode });
    else block.id = `${this.prefix}${id}`;
    return block;
  }

  /**
   * A block that the Scratch look has under the same name.
   *
   * @param {ScratchBlock} scratch
   * @returns {BlockState | null}
   */
  #ownBlock({ opcode, inputs = {}, fields = {} }) {
    const spec = BLOCKS.get(opcode);
    if (spec === undefined || spec.builtIn) return null;
    /** @type {BlockState} */ const block = { type: opcode };
    /** A name that the file uses, else the first input of the kind that nothing has taken. */
    const menus = Object.keys(inputs).filter((name) => this.#menu(inputs[name]) !== null);
    const values = Object.keys(inputs).filter((name) => !menus.includes(name));
    for (const arg of spec.args) {
      const { kind, name } = arg;
      if (kind === "choice")
        (block.fields ??= {})[name] = this.#choice(opcode, arg, take(menus, name), { inputs, fields });
      else if (kind === "variable")
        (block.fields ??= {})[name] = this.variable(fields[name] ?? Object.values(fields)[0]);
      else if (kind === "text") (block.fields ??= {})[name] = this.#message(opcode, { inputs, fields });
      else if (kind === "body") this.#plug(block, name, { block: this.chain(inputs[name]?.[1])[0] });
      else this.#plug(block, name, this.socket(inputs[take(values, name) ?? ""], arg));
    }
    return block;
  }

  /** @param {BlockState} block @param {string} name @param {Socket} socket */
  #plug(block, name, socket) {
    if (socket.block !== undefined || socket.shadow !== undefined) (block.inputs ??= {})[name] = socket;
  }

  /**
   * What an input has: a block, a number, or nothing.
   *
   * @param {any[] | undefined} input
   * @param {{ check?: string | null, fractions?: boolean }} [wanted]  what the block takes there
   * @returns {Socket}
   */
  socket(input, { check = "Number", fractions = false } = {}) {
    if (!Array.isArray(input)) return {};
    const [, first, under] = input;
    if (Array.isArray(first)) return this.#primitive(first, fractions);
    /** @type {Socket} */ const socket = {};
    const [block] = this.chain(first);
    if (block !== undefined) socket.block = block;
    // the number that shows again when the block is taken out
    if (check === "Number" && Array.isArray(under)) socket.shadow = numbered(Number(under[1]) || 0);
    return socket;
  }

  /** @param {any[]} primitive @param {boolean} fractions @returns {Socket} */
  #primitive([kind, value, id], fractions) {
    if (kind === VARIABLE) return { block: { type: "variables_get", fields: { VAR: this.variable([value, id]) } } };
    if (kind === LIST) {
      this.leaveOut("leftOutList");
      return {};
    }
    const text = String(value);
    const number = Number(text);
    const isNumber = Number.isFinite(number) && (text.trim() !== "" || !TEXTS.includes(kind));
    if (!isNumber) this.leaveOut("leftOutText", { text });
    else if (!fractions && !Number.isInteger(number)) {
      this.leaveOut("leftOutFraction", { text, used: Math.trunc(number) });
    }
    return { shadow: numbered(isNumber ? number : 0) };
  }

  /** The value of a menu: of its shadow block. @param {any[] | undefined} input @returns {string | null} */
  #menu(input) {
    const ids = Array.isArray(input) ? [input[1], input[2]].filter((each) => typeof each === "string") : [];
    const menu = ids.map((id) => this.blocks[id]).find((block) => block?.shadow && block.opcode.includes("_menu_"));
    return menu === undefined ? null : String(Object.values(menu.fields ?? {})[0]?.[0] ?? "");
  }

  /**
   * The option of a menu, a field or a written value; the first one for an empty or unknown value, and for a block.
   *
   * @param {string} opcode
   * @param {Arg} arg
   * @param {string | undefined} input
   * @param {{ inputs: Record<string, any[]>, fields: Record<string, any[]> }} scratch
   */
  #choice(opcode, { name, options = [] }, input, { inputs, fields }) {
    const initial = options[0][1];
    const top = inputs[input ?? name]?.[1];
    const isBlock = typeof top === "string" ? this.blocks[top]?.shadow !== true : top?.[0] === VARIABLE;
    const written = Array.isArray(top) ? top[1] : fields[name]?.[0];
    const given = String((input === undefined ? written : this.#menu(inputs[input])) ?? "");
    if (!isBlock && options.some(([, value]) => value === given)) return given;
    if (isBlock || given !== "") this.leaveOut("leftOutMenu", { opcode, used: initial });
    return initial;
  }

  /**
   * The name of a message: of a field, or of a primitive; for a block that computes it, the one under the block.
   *
   * @param {string} opcode
   * @param {{ inputs: Record<string, any[]>, fields: Record<string, any[]> }} scratch
   */
  #message(opcode, { inputs, fields }) {
    const field = Object.values(fields)[0]?.[0];
    const [, first, under] = Object.values(inputs)[0] ?? [];
    const isName = Array.isArray(first) && first[0] !== VARIABLE;
    const name = String(field ?? (isName ? first : Array.isArray(under) ? under : [])[1] ?? "");
    if (field === undefined && !isName && first !== undefined) this.leaveOut("leftOutMenu", { opcode, used: name });
    return name;
  }

  /** A field that names a variable. @param {any[] | undefined} field  its name and id */
  variable(field) {
    const wanted = String(field?.[0] ?? "");
    const key = String(field?.[1] ?? wanted);
    const known = this.variables.get(key);
    if (known !== undefined) return { id: known.id };
    // sprites may have variables of the same name, and names in Blockly do not differ in case only
    const names = new Set([...this.variables.values()].map(({ name }) => name.toLowerCase()));
    let name = wanted;
    for (let number = 2; names.has(name.toLowerCase()); number++) name = `${wanted} ${number}`;
    const variable = { id: `v${this.variables.size + 1}`, name };
    this.variables.set(key, variable);
    return { id: variable.id };
  }
}

/** Take a name out of a list, else the first one. @param {string[]} names @param {string} wanted */
function take(names, wanted) {
  const index = Math.max(0, names.indexOf(wanted));
  return names.splice(index, 1).at(0);
}

/** @param {any} value @returns {Record<string, any>} */
const recordOf = (value) => (typeof value === "object" && value !== null && !Array.isArray(value) ? value : {});

/** The entries of a record that are lists. @param {any} value @returns {Record<string, any[]>} */
const listsOf = (value) =>
  Object.fromEntries(Object.entries(recordOf(value)).filter(([, entry]) => Array.isArray(entry)));

/**
 * The blocks of a sprite in the form that the rest expects, whatever a file has. A variable alone on the workspace is a
 * list, not a block.
 *
 * @param {any} target
 * @returns {Record<string, ScratchBlock>}
 */
function blocksOf(target) {
  const blocks = Object.entries(recordOf(target?.blocks)).filter(([, block]) => !Array.isArray(block));
  return Object.fromEntries(
    blocks.map(([id, block]) => {
      const { opcode, inputs, fields, next, topLevel, shadow, x, y } = recordOf(block);
      const place = { x: Number(x) || 0, y: Number(y) || 0 };
      const below = typeof next === "string" ? next : null;
      return [
        id,
        {
          opcode: String(opcode ?? ""),
          inputs: listsOf(inputs),
          fields: listsOf(fields),
          next: below,
          topLevel: topLevel === true,
          shadow: shadow === true,
          ...place,
        },
      ];
    }),
  );
}
