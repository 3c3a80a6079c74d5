// Conditions and loops.

import { AND, COMPARE, NONE, NOT, OR } from "../precedence.js";
import { blocksFrom, plugged } from "../state.js";
import { body, booleanValue, choice, condition, integer, number, variable } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").BlockState} BlockState */
/** @typedef {import("./spec.js").Generator} Generator */
/** @typedef {import("./spec.js").Option} Option */

/** @type {Record<string, string>} */
const COMPARISONS = { EQ: "==", NEQ: "!=", LT: "<", LTE: "<=", GT: ">", GTE: ">=" };
/** @type {readonly Option[]} */
export const COMPARISON_OPTIONS = Object.keys(COMPARISONS).map((value) => [value.toLowerCase(), value]);
export const TRUE = booleanValue("0 == 0", COMPARE);
export const FALSE = booleanValue("0 == 1", COMPARE);
/** The largest number of a loop that counts up: the next one would not fit in 16 bits. */
const LAST_COUNT = 32766;

/** @param {Generator} g @param {BlockState} block */
function comparison(g, block) {
  const sides = ["A", "B"].map((side) => g.number(block, side, COMPARE));
  return booleanValue(sides.join(` ${COMPARISONS[g.field(block, "OP")]} `), COMPARE);
}

/** How many conditions an "if" has. @param {BlockState} block */
const branches = (block) => 1 + (block.extraState?.elseIfCount ?? 0);

/** Whether an "if" has an "else". @param {BlockState} block */
const hasElse = (block) => block.extraState?.hasElse === true;

/** Warn about a loop that waits for a sensor: its variable does not change before the handler ends. */
/** @param {Generator} g @param {BlockState} block @param {string} input */
function checkLoop(g, block, input) {
  for (const each of blocksFrom(plugged(block, input))) {
    if (g.spec(each)?.sensor) g.report("warning", "loopOnSensor", block);
  }
}

/** @type {BlockSpec["step"]} */
const ifStep = (script, block) => {
  const end = script.label();
  for (let index = 0; index < branches(block); index++) {
    const otherwise = script.label();
    const wanted = script.g.condition(block, `IF${index}`, NOT);
    script.jumpIf(block, `not ${wanted}`, otherwise);
    script.statements(block, `DO${index}`);
    script.jump(block, end);
    script.place(otherwise);
  }
  if (hasElse(block)) script.statements(block, "ELSE");
  script.place(end);
};

/** @type {readonly BlockSpec[]} */
export const LOGIC = [
  {
    type: "controls_if",
    shape: "statement",
    style: "logic_blocks",
    builtIn: true,
    args: [condition("IF0"), body("DO0"), body("ELSE")],
    statement(g, block) {
      const lines = [];
      for (let index = 0; index < branches(block); index++) {
        const word = index === 0 ? "if" : "elseif";
        lines.push(g.line(block, `${word} ${g.condition(block, `IF${index}`)} then`), ...g.body(block, `DO${index}`));
      }
      if (hasElse(block)) lines.push(g.line(block, "else"), ...g.body(block, "ELSE"));
      return [...lines, g.line(block, "end")];
    },
    step: ifStep,
  },
  {
    type: "thymio_when",
    shape: "statement",
    style: "logic_blocks",
    args: [condition("WHEN"), body("DO")],
    statement: (g, block) => [
      g.line(block, `when ${g.condition(block, "WHEN")} do`),
      ...g.body(block, "DO"),
      g.line(block, "end"),
    ],
  },
  {
    type: "thymio_compare",
    shape: "Boolean",
    style: "logic_blocks",
    args: [number("A", 0), choice("OP", "compare", COMPARISON_OPTIONS), number("B", 0)],
    value: comparison,
  },
  {
    type: "logic_compare",
    shape: "Boolean",
    style: "logic_blocks",
    builtIn: true,
    args: [
      choice("OP", "compare", COMPARISON_OPTIONS),
      { ...number("A"), check: null },
      { ...number("B"), check: null },
    ],
    value: (g, block) => (["A", "B"].every((side) => g.isNumber(block, side)) ? comparison(g, block) : FALSE),
  },
  {
    type: "logic_operation",
    shape: "Boolean",
    style: "logic_blocks",
    builtIn: true,
    args: [
      choice("OP", "operation", [
        ["and", "AND"],
        ["or", "OR"],
      ]),
      condition("A"),
      condition("B"),
    ],
    value(g, block) {
      const used = ["A", "B"].filter((side) => plugged(block, side) !== undefined);
      if (used.length === 0) return FALSE;
      if (used.length === 1) return g.conditionValue(block, used[0]);
      const [word, order] = g.field(block, "OP") === "OR" ? ["or", OR] : ["and", AND];
      return booleanValue(used.map((side) => g.condition(block, side, order)).join(` ${word} `), order);
    },
  },
  {
    type: "logic_negate",
    shape: "Boolean",
    style: "logic_blocks",
    builtIn: true,
    args: [condition("BOOL")],
    value: (g, block) => booleanValue(`not ${g.condition(block, "BOOL", NOT, TRUE)}`, NOT),
  },
  {
    type: "logic_boolean",
    shape: "Boolean",
    style: "logic_blocks",
    builtIn: true,
    args: [
      choice("BOOL", "boolean", [
        ["true", "TRUE"],
        ["false", "FALSE"],
      ]),
    ],
    value: (g, block) => (g.field(block, "BOOL") === "TRUE" ? TRUE : FALSE),
  },
];

/** @type {readonly BlockSpec[]} */
export const LOOPS = [
  {
    type: "controls_repeat",
    shape: "statement",
    style: "loop_blocks",
    builtIn: true,
    args: [integer("TIMES", 10, 0), body("DO")],
    statement(g, block) {
      const times = g.integer(block, "TIMES");
      if (times < 1) return [];
      if (times > LAST_COUNT) g.report("error", "numberRange", block, { value: times, least: 0, greatest: LAST_COUNT });
      const counter = g.fresh("count");
      return [g.line(block, `for ${counter} in 1:${times} do`), ...g.body(block, "DO"), g.line(block, "end")];
    },
    step: (script, block) =>
      script.repeat(block, String(Math.max(0, script.g.integer(block, "TIMES"))), () => script.statements(block, "DO")),
    waits: true,
  },
  {
    type: "controls_whileUntil",
    shape: "statement",
    style: "loop_blocks",
    builtIn: true,
    args: [
      choice("MODE", "while", [
        ["while", "WHILE"],
        ["until", "UNTIL"],
      ]),
      condition("BOOL"),
      body("DO"),
    ],
    statement(g, block) {
      checkLoop(g, block, "BOOL");
      const until = g.field(block, "MODE") === "UNTIL";
      const wanted = g.condition(block, "BOOL", until ? NOT : NONE);
      return [g.line(block, `while ${until ? "not " : ""}${wanted} do`), ...g.body(block, "DO"), g.line(block, "end")];
    },
    step(script, block) {
      const until = script.g.field(block, "MODE") === "UNTIL";
      const end = `${until ? "" : "not "}${script.g.condition(block, "BOOL", until ? NONE : NOT)}`;
      script.loop(block, end, () => script.statements(block, "DO"));
    },
    waits: true,
  },
  {
    type: "thymio_for",
    shape: "statement",
    style: "loop_blocks",
    args: [variable("ITER", "i"), integer("FROM", 0), integer("TO", 9), body("DO")],
    statement(g, block) {
      const [from, to] = ["FROM", "TO"].map((field) => g.integer(block, field));
      const step = from > to ? " step -1" : "";
      const range = `${from}:${to}${step}`;
      return [
        g.line(block, `for ${g.variable(block, "ITER")} in ${range} do`),
        ...g.body(block, "DO"),
        g.line(block, "end"),
      ];
    },
  },
];
