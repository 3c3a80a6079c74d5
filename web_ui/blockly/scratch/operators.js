// Scratch's operators, conditions and variables as blocks that Blockly programs have.

/** @typedef {import("../state.js").BlockState} BlockState */
/** @typedef {import("../state.js").Socket} Socket */
/** @typedef {import("./convert.js").Converter} Converter */
/** @typedef {import("./convert.js").ScratchBlock} ScratchBlock */
/**
 * @typedef {(converter: Converter, scratch: ScratchBlock) => BlockState | null} Operator  null if the robot has none
 */

/** A number that is written in an input. @param {number} value @returns {BlockState} */
export const numbered = (value) => ({ type: "math_number", fields: { NUM: value } });

/** Inputs without those that are empty. @param {Record<string, Socket>} inputs */
const filled = (inputs) =>
  Object.fromEntries(
    Object.entries(inputs).filter(([, { block, shadow }]) => block !== undefined || shadow !== undefined),
  );

/**
 * A block with an operator between two inputs.
 *
 * @param {string} type
 * @param {string} op
 * @param {readonly [string, string]} names  of Scratch's inputs
 * @param {{ check?: string }} [wanted]  what Aseba takes there
 * @returns {Operator}
 */
const between =
  (type, op, names, wanted = {}) =>
  (converter, { inputs = {} }) => {
    const [A, B] = names.map((name) => converter.socket(inputs[name], wanted));
    return { type, fields: { OP: op }, inputs: filled({ A, B }) };
  };

/** @type {readonly [string, string]} */
const NUMBERS = ["NUM1", "NUM2"];
/** @type {readonly [string, string]} */
const OPERANDS = ["OPERAND1", "OPERAND2"];

const CONDITION = { check: "Boolean" };

/** @type {Record<string, Operator>} */
export const OPERATORS = {
  operator_add: between("thymio_arithmetic", "+", NUMBERS),
  operator_subtract: between("thymio_arithmetic", "-", NUMBERS),
  operator_multiply: between("thymio_arithmetic", "*", NUMBERS),
  operator_divide: (converter, scratch) => {
    converter.leaveOut("leftOutDivision");
    return between("thymio_arithmetic", "/", NUMBERS)(converter, scratch);
  },
  operator_mod: between("thymio_arithmetic", "%", NUMBERS),
  operator_lt: between("thymio_compare", "LT", OPERANDS),
  operator_gt: between("thymio_compare", "GT", OPERANDS),
  operator_equals: between("thymio_compare", "EQ", OPERANDS),
  operator_and: between("logic_operation", "AND", OPERANDS, CONDITION),
  operator_or: between("logic_operation", "OR", OPERANDS, CONDITION),
  operator_not: (converter, { inputs = {} }) => ({
    type: "logic_negate",
    inputs: filled({ BOOL: converter.socket(inputs.OPERAND, CONDITION) }),
  }),
  operator_mathop: (converter, { inputs = {}, fields = {} }) => {
    if (fields.OPERATOR?.[0] !== "abs") return null;
    return { type: "thymio_unary", fields: { OP: "abs" }, inputs: filled({ VALUE: converter.socket(inputs.NUM) }) };
  },
  control_if: (converter, { inputs = {} }) => ({
    type: "controls_if",
    inputs: filled({
      IF0: converter.socket(inputs.CONDITION, CONDITION),
      DO0: { block: converter.chain(inputs.SUBSTACK?.[1])[0] },
    }),
  }),
  control_if_else: (converter, { inputs = {} }) => ({
    type: "controls_if",
    extraState: { hasElse: true },
    inputs: filled({
      IF0: converter.socket(inputs.CONDITION, CONDITION),
      DO0: { block: converter.chain(inputs.SUBSTACK?.[1])[0] },
      ELSE: { block: converter.chain(inputs.SUBSTACK2?.[1])[0] },
    }),
  }),
  // all sensors at once, as one text
  thymio_proxHorizontal: () => null,
  thymio_proxGroundDelta: () => null,
  data_variable: (converter, { fields = {} }) => ({
    type: "variables_get",
    fields: { VAR: converter.variable(fields.VARIABLE) },
  }),
  data_setvariableto: (converter, { inputs = {}, fields = {} }) => ({
    type: "variables_set",
    fields: { VAR: converter.variable(fields.VARIABLE) },
    inputs: filled({ VALUE: converter.socket(inputs.VALUE) }),
  }),
};
