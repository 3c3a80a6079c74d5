// Generates the Aseba program of a workspace, with the block of each line.
//
// The parts of a program: declarations, statements without a hat (they run at the start), subroutines, event handlers.
// Several hats of one event become one handler, because Aseba allows one.

import { BLOCKS } from "./blocks/index.js";
import { FALSE } from "./blocks/logic.js";
import { numberValue } from "./blocks/spec.js";
import { DEFINITIONS, LIST_BLOCKS, listSize } from "./blocks/variables.js";
import { indented, joined, plain } from "./lines.js";
import { Names } from "./names.js";
import { COMPARE, NONE, operand } from "./precedence.js";
import { LIBRARY_NAMES } from "./scratch/library.js";
import { Script, ScriptRunner } from "./scratch/script.js";
import { allBlocks, blocksFrom, following, isDisabled, plugged, topBlocks, variableName } from "./state.js";
import { Subroutines } from "./subroutines.js";

/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("./blocks/spec.js").Line} Line */
/** @typedef {import("./blocks/spec.js").Value} Value */
/**
 * @typedef {object} Problem
 * @property {"error" | "warning"} severity
 * @property {string} key     of `problem.<key>` in the texts
 * @property {Record<string, string | number>} values
 * @property {string | null} id  of the block
 */
/**
 * @typedef {object} Generated
 * @property {string} code
 * @property {(string | null)[]} blocks  the id of the block of each line
 * @property {Problem[]} problems
 */

const LEAST = -32768;
const GREATEST = 32767;
const ZERO = numberValue("0");

/**
 * @param {WorkspaceState} state
 * @param {{ reserved?: Iterable<string> }} [options]  names that the program cannot use, such as those of constants
 * @returns {Generated}
 */
export function generate(state, { reserved = [] } = {}) {
  const generator = new Generator(state, reserved);
  const lines = generator.run();
  const code = lines.map(({ text }) => `${text}\n`).join("");
  return { code, blocks: lines.map(({ id }) => id), problems: generator.problems };
}

/**
 * The lines of a block, those of the blocks inside included: first and last, from 0; null if it has none.
 *
 * @param {readonly (string | null)[]} blocks  the id of the block of each line
 * @param {WorkspaceState} state
 * @param {string} id
 */
export function linesOfBlock(blocks, state, id) {
  const block = [...allBlocks(state)].find((each) => each.id === id);
  if (block === undefined) return null;
  const alone = { ...block, next: undefined };
  const inside = new Set([...blocksFrom(alone)].map((each) => each.id));
  const lines = blocks.flatMap((each, line) => (each !== null && inside.has(each) ? [line] : []));
  return lines.length === 0 ? null : { first: lines[0], last: lines[lines.length - 1] };
}

export class Generator {
  /** @param {WorkspaceState} state @param {Iterable<string>} reserved */
  constructor(state, reserved) {
    this.state = state;
    this.names = new Names([...reserved, ...LIBRARY_NAMES]);
    /** Name in the program → size, 0 for a single number. @type {Map<string, number>} */ this.declared = new Map();
    /** @type {Map<string, Line[][]>} */ this.handlers = new Map();
    /** @type {Line[][]} */ this.start = [];
    /** @type {Problem[]} */ this.problems = [];
    this.subroutines = new Subroutines(this);
    this.scripts = new ScriptRunner(this);
    this.#declareVariables();
  }

  /** @returns {Line[]} */
  run() {
    const tops = topBlocks(this.state).filter((block) => !isDisabled(block) || following(block) !== undefined);
    for (const block of tops) this.subroutines.declare(block);
    for (const block of tops) this.#top(block);
    this.scripts.finish();
    const declarations = [...this.declared].map(([name, size]) => plain(`var ${name}${size > 0 ? `[${size}]` : ""}`));
    const handlers = [...this.handlers].map(([event, groups]) => {
      const id = groups.flat().find((line) => line.id !== null)?.id ?? null;
      return [{ text: `onevent ${event}`, id }, ...indented(joined(groups, 1))];
    });
    const parts = [declarations, joined(this.start, 1), joined(this.subroutines.parts(), 1), joined(handlers, 1)];
    return joined(
      parts.filter((part) => part.length > 0),
      2,
    );
  }

  // -- what the descriptions of blocks use ---------------------------------------------------------------------------

  /** @param {BlockState} block */
  spec(block) {
    return BLOCKS.get(block.type);
  }

  /** A line of the program. @param {BlockState} block @param {string} text @returns {Line} */
  line(block, text) {
    return { text, id: block.id ?? null };
  }

  /** The value of a field, else that of a new block. @param {BlockState} block @param {string} name */
  field(block, name) {
    const arg = this.spec(block)?.args.find((each) => each.name === name);
    const value = String(block.fields?.[name] ?? arg?.initial ?? "");
    const isValid = arg?.options === undefined || arg.options.some(([, option]) => option === value);
    return isValid ? value : String(arg?.initial);
  }

  /** The integer part of a field. @param {BlockState} block @param {string} name */
  integer(block, name) {
    const value = Math.trunc(Number(this.field(block, name))) + 0; // not -0
    if (!Number.isFinite(value)) return 0;
    if (value < LEAST || value > GREATEST) {
      this.report("error", "numberRange", block, { value, least: LEAST, greatest: GREATEST });
    }
    return value;
  }

  /** Whether an input has a number, or nothing. @param {BlockState} block @param {string} input */
  isNumber(block, input) {
    const inner = plugged(block, input);
    return inner === undefined || this.spec(inner)?.shape === "Number";
  }

  /**
   * What is plugged in, as a number; 0 if it is none.
   *
   * @param {BlockState} block
   * @param {string} input
   * @returns {Value}
   */
  numberValue(block, input) {
    const value = this.#value(plugged(block, input));
    return value?.type === "Number" ? value : ZERO;
  }

  /** @param {BlockState} block @param {string} input @param {number} [outer]  the operator around it */
  number(block, input, outer = NONE) {
    return operand(this.numberValue(block, input), outer);
  }

  /**
   * The number in an input if it is written there, fractions included; null for anything else.
   *
   * @param {BlockState} block
   * @param {string} input
   */
  constant(block, input) {
    const inner = plugged(block, input);
    return inner?.type === "math_number" ? Number(this.field(inner, "NUM")) || 0 : null;
  }

  /**
   * What is plugged in, as a condition; Aseba needs a comparison, so a number is compared with 0.
   *
   * @param {BlockState} block
   * @param {string} input
   * @param {Value} [empty]
   * @returns {Value}
   */
  conditionValue(block, input, empty = FALSE) {
    const value = this.#value(plugged(block, input));
    if (value === null) return empty;
    if (value.type === "Boolean") return value;
    return { code: `${operand(value, COMPARE)} != 0`, order: COMPARE, type: "Boolean" };
  }

  /** @param {BlockState} block @param {string} input @param {number} [outer] @param {Value} [empty] */
  condition(block, input, outer = NONE, empty = FALSE) {
    return operand(this.conditionValue(block, input, empty), outer);
  }

  /** The statements in an input. @param {BlockState} block @param {string} input @returns {Line[]} */
  statements(block, input) {
    return this.chain(plugged(block, input));
  }

  /** The statements in an input, indented. @param {BlockState} block @param {string} input */
  body(block, input) {
    return indented(this.statements(block, input));
  }

  /** The name of a variable in the program. @param {BlockState} block @param {string} field */
  variable(block, field) {
    const spec = this.spec(block)?.args.find(({ name }) => name === field);
    return this.names.get("variable", variableName(this.state, block.fields?.[field] ?? spec?.initial));
  }

  /** A variable as one number: of a list, the first element. @param {BlockState} block @param {string} field */
  scalar(block, field) {
    const name = this.variable(block, field);
    return (this.declared.get(name) ?? 0) > 0 ? `${name}[0]` : name;
  }

  /** The name of the subroutine that a block calls. @param {BlockState} block */
  subroutine(block) {
    return this.subroutines.call(block);
  }

  /** Declare a further variable. @param {string} wanted @param {number} [size] @returns {string} */
  fresh(wanted, size = 0) {
    const name = this.names.fresh(wanted);
    this.declared.set(name, size);
    return name;
  }

  /**
   * @param {"error" | "warning"} severity
   * @param {string} key
   * @param {BlockState} block
   * @param {Record<string, string | number>} [values]
   */
  report(severity, key, block, values = {}) {
    const id = block.id ?? null;
    const known = this.problems.some((each) => each.key === key && each.id === id);
    if (!known) this.problems.push({ severity, key, values, id });
  }

  /** Statements from a block downwards. @param {BlockState | undefined} first @returns {Line[]} */
  chain(first) {
    /** @type {Line[]} */ const lines = [];
    for (let block = first; block !== undefined; block = following(block)) lines.push(...this.one(block));
    return lines;
  }

  /** One statement, its comment in front. @param {BlockState} block @returns {Line[]} */
  one(block) {
    if (isDisabled(block)) return [];
    const spec = this.spec(block);
    if (spec?.statement !== undefined) return [...this.comments(block), ...spec.statement(this, block)];
    if (spec === undefined) this.report("error", "unknownBlock", block, { type: block.type });
    else if (spec.step !== undefined) this.report("error", "needsScript", block);
    return [];
  }

  /** The comments of a block and of the values in it. @param {BlockState} block @returns {Line[]} */
  comments(block) {
    const texts = [block, ...this.#values(block)].map((each) => each.icons?.comment?.text ?? "");
    return texts
      .flatMap((text) => (text === "" ? [] : text.split(/\r\n|\r|\n/)))
      .map((text) => this.line(block, `# ${text}`.trimEnd()));
  }

  /** Add statements to the handler of an event. @param {string} event @param {Line[]} lines */
  handle(event, lines) {
    this.handlers.set(event, [...(this.handlers.get(event) ?? []), lines]);
  }

  // -- inside --------------------------------------------------------------------------------------------------------

  /** @param {BlockState} block */
  #top(block) {
    const spec = this.spec(block);
    if (isDisabled(block)) {
      if (spec?.shape === "statement") this.start.push(this.chain(following(block)));
      return;
    }
    if (spec?.hat !== undefined) {
      const { event, lines } = spec.hat(this, block);
      this.handle(event, [...this.comments(block), ...lines]);
    } else if (spec?.trigger !== undefined) {
      this.scripts.add(block);
    } else if (DEFINITIONS.includes(block.type)) {
      this.subroutines.define(block);
    } else if (spec?.value !== undefined) {
      this.report("warning", "looseValue", block);
    } else if (Script.takesTime(block)) {
      this.scripts.add(block);
    } else {
      this.start.push(this.chain(block));
    }
  }

  /** @param {BlockState | undefined} block @returns {Value | null} */
  #value(block) {
    if (block === undefined || isDisabled(block)) return null;
    const spec = this.spec(block);
    if (spec?.value !== undefined) return spec.value(this, block);
    this.report("error", "unknownBlock", block, { type: block.type });
    return null;
  }

  /** The blocks inside that are values. @param {BlockState} block @returns {BlockState[]} */
  #values(block) {
    const inner = Object.keys(block.inputs ?? {}).map((input) => plugged(block, input));
    return inner.flatMap((each) =>
      each !== undefined && this.spec(each)?.value !== undefined ? [each, ...this.#values(each)] : [],
    );
  }

  #declareVariables() {
    for (const block of allBlocks(this.state)) {
      for (const { kind, name: field } of this.spec(block)?.args ?? []) {
        if (kind !== "variable") continue;
        const name = this.variable(block, field);
        const least = LIST_BLOCKS.includes(block.type) ? 1 : 0;
        const size = block.type === "thymio_declare_array" ? listSize(this.field(block, "SIZE")) : least;
        this.declared.set(name, Math.max(size, this.declared.get(name) ?? 0));
      }
    }
  }
}
