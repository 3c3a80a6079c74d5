// How a block is described: its fields and inputs, once, for its definition in Blockly, for files and for the
// generator.

import { ATOM } from "../precedence.js";

/** @typedef {import("../state.js").BlockState} BlockState */
/** @typedef {import("../generator.js").Generator} Generator */
/** @typedef {import("../scratch/script.js").ScriptRunner} ScriptRunner */
/** @typedef {(script: import("../scratch/script.js").Script, block: BlockState) => void} Step */
/**
 * @typedef {{ code: string, order: number, type: "Number" | "Boolean" }} Value  an expression, how strongly it binds
 */
/** @typedef {{ text: string, id: string | null }} Line  a line of the program and the block it comes from */
/** @typedef {{ event: string, lines: Line[] }} Handler */
/**
 * @typedef {object} Arg
 * @property {"choice" | "variable" | "integer" | "text" | "color" | "value" | "body"} kind
 * @property {string} name
 * @property {string} [set]                   choice: names the texts of its options
 * @property {readonly Option[]} [options]    choice
 * @property {string | number} [initial]      field: what a new block has
 * @property {number} [least]                 integer
 * @property {"Number" | "Boolean" | null} [check]  value: what may be plugged in, null for anything
 * @property {number} [shadow]                value: what a new block has in it
 * @property {boolean} [fractions]            value: whether a number written in it may have a fraction
 * @property {string} [former]                the name in files of earlier versions of this project, which is read
 */
/** @typedef {readonly [word: string, value: string]} Option  the word names its text, the value is in files */
/**
 * @typedef {object} BlockSpec
 * @property {string} type
 * @property {"hat" | "statement" | "Number" | "Boolean"} shape
 * @property {string} style
 * @property {readonly Arg[]} args            in the order of files
 * @property {boolean} [builtIn]              whether Blockly defines the block
 * @property {boolean} [anywhere]             a value that fits conditions, too
 * @property {boolean} [sensor]               whether it reads what only changes between two events
 * @property {(g: Generator, block: BlockState) => Value} [value]
 * @property {(g: Generator, block: BlockState) => Line[]} [statement]
 * @property {(g: Generator, block: BlockState) => Handler} [hat]
 * @property {Step} [step]                    a statement of a script, which may take time
 * @property {boolean} [waits]                whether its step takes time even if all statements inside take none
 * @property {(runner: ScriptRunner, block: BlockState, start: Line[]) => void} [trigger]  a hat that starts a script
 */

/**
 * @param {string} name
 * @param {string} set
 * @param {readonly Option[]} options
 * @param {string} [initial]
 * @returns {Arg}
 */
export const choice = (name, set, options, initial = options[0][1]) => ({ kind: "choice", name, set, options, initial });

/** @param {string} name @param {string} initial @returns {Arg} */
export const variable = (name, initial) => ({ kind: "variable", name, initial });

/** @param {string} name @param {number} initial @param {number} [least] @returns {Arg} */
export const integer = (name, initial, least) => ({ kind: "integer", name, initial, least });

/** @param {string} name @param {string} initial @returns {Arg} */
export const text = (name, initial) => ({ kind: "text", name, initial });

/** @param {string} name @param {string} initial @returns {Arg} */
export const color = (name, initial) => ({ kind: "color", name, initial });

/** @param {string} name @param {number} [shadow] @returns {Arg} */
export const number = (name, shadow) => ({ kind: "value", name, check: "Number", shadow });

/** @param {string} name @param {number} [shadow] @returns {Arg} */
export const seconds = (name, shadow) => ({ ...number(name, shadow), fractions: true });

/** An argument that files of earlier versions call otherwise. @param {string} former @param {Arg} arg @returns {Arg} */
export const renamed = (former, arg) => ({ ...arg, former });

/** @param {string} name @returns {Arg} */
export const condition = (name) => ({ kind: "value", name, check: "Boolean" });

/** @param {string} name @returns {Arg} */
export const body = (name) => ({ kind: "body", name });

/** @param {string} code @param {number} [order] @returns {Value} */
export const numberValue = (code, order = ATOM) => ({ code, order, type: "Number" });

/** @param {string} code @param {number} order @returns {Value} */
export const booleanValue = (code, order) => ({ code, order, type: "Boolean" });

/**
 * A native function with the numbers of inputs as arguments.
 *
 * @param {string} native
 * @param {readonly string[]} values
 */
export const call = (native, values) => `call ${native}(${values.join(",")})`;
