// How strongly the operators of Aseba bind: a smaller number binds more strongly.

export const ATOM = 0;
/** An index and the unary minus. */
export const UNARY = 1;
export const BIT_NOT = 2;
export const ABS = 3;
export const MULTIPLY = 4;
export const ADD = 5;
export const SHIFT = 6;
export const BIT_AND = 7;
export const BIT_XOR = 8;
export const BIT_OR = 9;
export const COMPARE = 10;
export const NOT = 11;
export const AND = 12;
export const OR = 13;
/** Around a whole expression: no operator. */
export const NONE = 99;

/**
 * An expression as operand: in parentheses if it binds as strongly as the operator or more weakly, on either side,
 * so that the text shows the tree of the blocks.
 *
 * @param {{ code: string, order: number }} inner
 * @param {number} outer
 */
export function operand({ code, order }, outer) {
  return order !== ATOM && order >= outer ? `(${code})` : code;
}
