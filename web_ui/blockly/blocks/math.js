// Numbers and what is computed from them.

import { ABS, ADD, ATOM, BIT_AND, BIT_NOT, BIT_OR, BIT_XOR, MULTIPLY, SHIFT, UNARY } from "../precedence.js";
import { choice, number, numberValue, renamed } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").Option} Option */

/** @type {Record<string, number>} */
const ORDER = {
  "+": ADD,
  "-": ADD,
  "*": MULTIPLY,
  "/": MULTIPLY,
  "%": MULTIPLY,
  "<<": SHIFT,
  ">>": SHIFT,
  "&": BIT_AND,
  "|": BIT_OR,
  "^": BIT_XOR,
};

/** @type {readonly Option[]} */
const ARITHMETIC = [
  ["plus", "+"],
  ["minus", "-"],
  ["times", "*"],
  ["divided", "/"],
  ["remainder", "%"],
];

/** @type {readonly Option[]} */
const BINARY = [
  ["shift_left", "<<"],
  ["shift_right", ">>"],
  ["and", "&"],
  ["or", "|"],
  ["xor", "^"],
];

/** @type {readonly Option[]} */
const UNARY_OPTIONS = [
  ["minus", "-"],
  ["abs", "abs"],
  ["not", "~"],
];

/** Blockly's names of operators. @type {Record<string, string>} */
const STANDARD = { ADD: "+", MINUS: "-", MULTIPLY: "*", DIVIDE: "/" };

/** @type {BlockSpec["value"]} */
const binary = (g, block) => {
  const operator = g.field(block, "OP");
  const order = ORDER[operator];
  return numberValue(`${g.number(block, "A", order)} ${operator} ${g.number(block, "B", order)}`, order);
};

/** @type {readonly BlockSpec[]} */
export const MATH = [
  {
    type: "math_number",
    shape: "Number",
    style: "math_blocks",
    builtIn: true,
    args: [{ kind: "integer", name: "NUM", initial: 0 }],
    value(g, block) {
      const value = g.integer(block, "NUM");
      return numberValue(String(value), value < 0 ? UNARY : ATOM);
    },
  },
  {
    type: "thymio_arithmetic",
    shape: "Number",
    style: "math_blocks",
    args: [number("A", 1), choice("OP", "arithmetic", ARITHMETIC), number("B", 1)],
    value: binary,
  },
  {
    type: "thymio_unary",
    shape: "Number",
    style: "math_blocks",
    args: [choice("OP", "unary", UNARY_OPTIONS), renamed("A", number("VALUE", 0))],
    value(g, block) {
      const operator = g.field(block, "OP");
      if (operator === "abs") return numberValue(`abs ${g.number(block, "VALUE", ABS)}`, ABS);
      const order = operator === "~" ? BIT_NOT : UNARY;
      return numberValue(`${operator}${g.number(block, "VALUE", order)}`, order);
    },
  },
  {
    type: "thymio_binary",
    shape: "Number",
    style: "math_blocks",
    args: [number("A", 1), choice("OP", "binary", BINARY), number("B", 1)],
    value: binary,
  },
  {
    type: "math_arithmetic",
    shape: "Number",
    style: "math_blocks",
    builtIn: true,
    args: [
      choice(
        "OP",
        "arithmetic",
        [...Object.keys(STANDARD), "POWER"].map((value) => [value.toLowerCase(), value]),
      ),
      number("A", 1),
      number("B", 1),
    ],
    value(g, block) {
      const operator = STANDARD[g.field(block, "OP")];
      if (operator === undefined) {
        g.report("warning", "noPower", block);
        return g.numberValue(block, "A");
      }
      const order = ORDER[operator];
      return numberValue(`${g.number(block, "A", order)} ${operator} ${g.number(block, "B", order)}`, order);
    },
  },
];
