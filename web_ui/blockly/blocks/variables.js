// Variables, lists and subroutines. Both vocabularies of variables occur in files; they mean the same.

import { UNARY } from "../precedence.js";
import { body, number, numberValue, text, variable } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").BlockState} BlockState */
/** @typedef {import("./spec.js").Generator} Generator */

/** @param {string} type @param {boolean} builtIn @returns {BlockSpec} */
const getter = (type, builtIn) => ({
  type,
  shape: "Number",
  style: "variable_blocks",
  builtIn,
  anywhere: true,
  args: [variable("VAR", "speed")],
  value(g, block) {
    const code = g.scalar(block, "VAR");
    return numberValue(code, code.endsWith("]") ? UNARY : undefined);
  },
});

/** @param {string} type @param {boolean} builtIn @returns {BlockSpec} */
const setter = (type, builtIn) => ({
  type,
  shape: "statement",
  style: "variable_blocks",
  builtIn,
  args: [variable("VAR", "speed"), { ...number("VALUE", 0), check: null }],
  statement: (g, block) => [g.line(block, `${g.scalar(block, "VAR")} = ${g.number(block, "VALUE")}`)],
});

/** @param {Generator} g @param {BlockState} block */
const element = (g, block) => `${g.variable(block, "VAR")}[${g.number(block, "INDEX")}]`;

/** @type {readonly BlockSpec[]} */
export const VARIABLES = [
  getter("thymio_variable_get", false),
  setter("thymio_variable_set", false),
  getter("variables_get", true),
  setter("variables_set", true),
  {
    type: "thymio_declare_array",
    shape: "statement",
    style: "variable_blocks",
    args: [variable("VAR", "list"), text("SIZE", "3")],
    statement: () => [],
  },
  {
    type: "thymio_set_array",
    shape: "statement",
    style: "variable_blocks",
    args: [variable("VAR", "list"), number("INDEX", 0), number("VALUE", 0)],
    statement: (g, block) => [g.line(block, `${element(g, block)} = ${g.number(block, "VALUE")}`)],
  },
  {
    type: "thymio_get_array",
    shape: "Number",
    style: "variable_blocks",
    args: [variable("VAR", "list"), number("INDEX", 0)],
    value: (g, block) => numberValue(element(g, block), UNARY),
  },
];

/** The size that a list is declared with: at least 1. @param {any} field */
export function listSize(field) {
  const size = Math.trunc(Number(field));
  return Number.isFinite(size) ? Math.max(1, size) : 1;
}

/** Blocks that use their variable as a list. */
export const LIST_BLOCKS = ["thymio_declare_array", "thymio_set_array", "thymio_get_array"];

/** Blocks that define a subroutine. */
export const DEFINITIONS = ["thymio_subroutine_define", "procedures_defnoreturn"];
/** The block that calls one. */
export const CALL = "procedures_callnoreturn";

/** The name in a block that defines or calls a subroutine. @param {BlockState} block */
export function subroutineName({ type, fields, extraState }) {
  return String((type === CALL ? extraState?.name : fields?.NAME) ?? fields?.NAME ?? "");
}

/** @type {readonly BlockSpec[]} */
export const SUBROUTINES = [
  ...DEFINITIONS.map((type) => ({
    type,
    shape: /** @type {const} */ ("hat"),
    style: "procedure_blocks",
    builtIn: type.startsWith("procedures"),
    args: [text("NAME", "subroutine"), body("STACK")],
  })),
  {
    type: CALL,
    shape: "statement",
    style: "procedure_blocks",
    builtIn: true,
    args: [text("NAME", "")],
    statement: (g, block) => [g.line(block, `callsub ${g.subroutine(block)}`)],
  },
];
