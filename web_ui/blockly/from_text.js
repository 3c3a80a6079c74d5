// Aseba text as blocks: the same statements, a block for each. Pure.
//
// It is for programs that are generated, such as those of VPL and of blocks. A text may have what no block stands for; the
// first such place is reported, and there are no blocks then.

import { parser } from "../editor/parser.js";
import { BLOCKS } from "./blocks/index.js";
import { SENSORS } from "./blocks/sensors.js";

/** @typedef {import("@lezer/common").SyntaxNode} Node */
/** @typedef {import("./state.js").BlockState} BlockState */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/** @typedef {{ line: number, text: string }} Unknown  a line, from 1, that no block stands for */

/** @typedef {[type: string, fields?: Record<string, string>]} Kind  of a block */

/** Events → hat. @type {Record<string, Kind>} */
const HATS = {
  tap: ["thymio_event_shock"],
  timer0: ["thymio_event_timer", { EVENT: "timer0" }],
  timer1: ["thymio_event_timer", { EVENT: "timer1" }],
  mic: ["thymio_event_sound", { EVENT: "mic" }],
  "sound.finished": ["thymio_event_sound", { EVENT: "sound.finished" }],
  "prox.comm": ["thymio_event_receive", { EVENT: "prox.comm" }],
  rc5: ["thymio_event_receive", { EVENT: "rc5" }],
  ...Object.fromEntries(
    ["buttons", "prox", "temperature", "acc", "motor"].map((name) => [name, ["thymio_event_update", { EVENT: name }]]),
  ),
};

/** Variables of the robot → statement that sets them. @type {Record<string, Kind>} */
const TARGETS = {
  "mic.threshold": ["thymio_actuator_mic"],
  "prox.comm.tx": ["thymio_actuator_comm"],
  ...Object.fromEntries(
    ["motor.left.target", "motor.right.target"].map((name) => [name, ["thymio_actuator_motor", { VARIABLE: name }]]),
  ),
  ...Object.fromEntries(
    ["timer.period[0]", "timer.period[1]"].map((name) => [name, ["thymio_actuator_timer", { VARIABLE: name }]]),
  ),
};

/** Functions → statement with an input for each argument. @type {Record<string, Kind>} */
const FUNCTIONS = {
  "leds.circle": ["thymio_led_circle"],
  "leds.prox.h": ["thymio_led_prox"],
  "leds.prox.v": ["thymio_led_prox_ground"],
  "leds.buttons": ["thymio_led_button"],
  "leds.temperature": ["thymio_led_temperature"],
  "sound.freq": ["thymio_sound_note"],
  "sound.play": ["thymio_soundPlaySd"],
  ...Object.fromEntries(
    ["leds.top", "leds.bottom.left", "leds.bottom.right"].map((LED) => [LED, ["thymio_led_rgb", { LED }]]),
  ),
  ...Object.fromEntries(["leds.rc", "leds.sound"].map((LED) => [LED, ["thymio_led_rc_sound", { LED }]])),
};

/** Functions whose first argument is a variable that they set or use. @type {Record<string, string>} */
const WITH_VARIABLE = {
  "math.cos": "thymio_math_cos",
  "math.atan2": "thymio_math_atan2",
  "sound.wave": "thymio_sound_wave",
};

/** Values of the robot → block and its field, from the descriptions of the blocks. */
const READINGS = new Map(
  SENSORS.filter(({ shape }) => shape === "Number").flatMap(({ type, args, value }) => {
    if (args.length > 0) return (args[0].options ?? []).map(([, name]) => [name, { type, fields: { SENSOR: name } }]);
    return [[value?.(/** @type {any} */ (null), { type }).code ?? "", { type }]];
  }),
);

/** @type {Record<string, string>} */
const COMPARISONS = { "==": "EQ", "!=": "NEQ", "<": "LT", "<=": "LTE", ">": "GT", ">=": "GTE" };
const BITS = ["<<", ">>", "&", "|", "^"];
const PRESSED = /^(button\.\w+) == 1$/;
/** The event of a button, which has blocks only if its statements wait for a change of the button. */
const BUTTON_EVENT = /^button\.(?:center|forward|backward|left|right)$/;
const CHANGES = { 0: "RELEASE", 1: "PRESS" };
/** Places of blocks in the workspace, and the greatest height of a statement, in pixels at scale 1. */
const [LEFT, TOP, GAP, HEIGHT] = [20, 20, 60, 45];

/** What no block stands for. */
class NoBlock extends Error {
  /** @param {Node} node */
  constructor(node) {
    super(`no block for ${node.name}`);
    this.at = node.from;
  }
}

/**
 * The workspace of a program.
 *
 * @param {string} code
 * @param {{ skipped?: readonly string[] }} [options]   events that are not emitted by the blocks
 * @returns {{ state: WorkspaceState, unknown: null } | { state: null, unknown: Unknown }}
 */
export function blocksOfText(code, { skipped = [] } = {}) {
  try {
    return { state: new Reader(code, skipped).workspace(), unknown: null };
  } catch (error) {
    if (!(error instanceof NoBlock)) throw error;
    const lines = code.slice(0, error.at).split("\n");
    return { state: null, unknown: { line: lines.length, text: code.split("\n")[lines.length - 1].trim() } };
  }
}

class Reader {
  /** Sizes of the variables of the program, 0 for a single number. @type {Map<string, number>} */ #sizes = new Map();

  /** @param {string} code @param {readonly string[]} skipped */
  constructor(code, skipped) {
    this.code = code;
    this.skipped = skipped;
  }

  /** @returns {WorkspaceState} */
  workspace() {
    const parts = children(parser.parse(this.code).topNode);
    const isPart = (/** @type {Node} */ { name }) => name === "Handler" || name === "Subroutine";
    const start = this.#statements(parts.filter((node) => !isPart(node)));
    const hats = parts.filter(isPart).flatMap((part) => this.#hats(part));
    let y = TOP;
    // one below the other, what runs at the start at the end: the events are what a program is about
    const blocks = [...hats, ...(start === undefined ? [] : [start])].map((block) => {
      const placed = { ...block, x: LEFT, y };
      y += GAP + HEIGHT * sizeOf(block);
      return placed;
    });
    const variables = [...this.#sizes.keys()].map((name) => ({ id: name, name }));
    return { blocks: { languageVersion: 0, blocks }, variables };
  }

  /** @param {Node} node @returns {BlockState[]} */
  #hats(node) {
    const [, name, ...inside] = children(node);
    if (node.name === "Subroutine") {
      const type = "procedures_defnoreturn";
      return [{ type, fields: { NAME: this.#text(name) }, inputs: this.#bodies({ STACK: inside }) }];
    }
    const event = this.#text(name);
    if (BUTTON_EVENT.test(event)) return inside.map((statement) => this.#buttonHat(event, statement));
    const found = HATS[event];
    if (found === undefined) throw new NoBlock(node);
    const [type, fields] = found;
    return [{ type, ...(fields && { fields }), inputs: this.#bodies({ HANDLER: inside }) }];
  }

  /** @param {string} button @param {Node} statement  of the handler of its event @returns {BlockState} */
  #buttonHat(button, statement) {
    const [, condition, , ...rest] = statement.name === "WhenStatement" ? children(statement) : [];
    for (const [value, MODE] of Object.entries(CHANGES)) {
      if (condition === undefined || this.#text(condition) !== `${button} == ${value}`) continue;
      const inputs = this.#bodies({ HANDLER: rest.slice(0, -1) });
      return { type: "thymio_event_button", fields: { BUTTON: button, MODE }, inputs };
    }
    throw new NoBlock(statement);
  }

  /** Statements, each below the one before. @param {readonly Node[]} nodes @returns {BlockState | undefined} */
  #statements(nodes) {
    const all = nodes.flatMap((node) => this.#statement(node));
    return all.reduceRight((/** @type {BlockState | undefined} */ next, block) => {
      return next === undefined ? block : { ...block, next: { block: next } };
    }, undefined);
  }

  /** @param {Record<string, readonly Node[]>} parts  statements by input */
  #bodies(parts) {
    const inputs = Object.entries(parts).map(([name, nodes]) => [name, this.#statements(nodes)]);
    return Object.fromEntries(inputs.flatMap(([name, block]) => (block === undefined ? [] : [[name, { block }]])));
  }

  /** @param {Node} node @returns {BlockState[]} */
  #statement(node) {
    const parts = children(node);
    switch (node.name) {
      case "VariableDefinition":
        return this.#definition(node, parts);
      case "Assignment":
        return [this.#assignment(parts)];
      case "CallStatement":
        return this.#call(node, parts);
      case "CallsubStatement":
        return [{ type: "procedures_callnoreturn", extraState: { name: this.#text(parts[1]) } }];
      case "EmitStatement":
        if (this.skipped.includes(this.#text(parts[1]))) return [];
        throw new NoBlock(node);
      case "IfStatement":
        return [this.#if(parts)];
      case "WhenStatement":
        return [this.#conditional("thymio_when", "WHEN", parts)];
      case "WhileStatement":
        return [{ ...this.#conditional("controls_whileUntil", "BOOL", parts), fields: { MODE: "WHILE" } }];
      case "ForStatement":
        return [this.#for(node, parts)];
      default:
        throw new NoBlock(node);
    }
  }

  /** @param {string} type @param {string} input @param {readonly Node[]} parts */
  #conditional(type, input, [, condition, , ...rest]) {
    return { type, inputs: { [input]: this.#socket(condition), ...this.#bodies({ DO: rest.slice(0, -1) }) } };
  }

  /** @param {readonly Node[]} parts @returns {BlockState} */
  #if([, condition, , ...rest]) {
    const isBody = (/** @type {Node} */ { name }) => !["ElseifClause", "ElseClause", "end"].includes(name);
    const others = rest.filter(({ name }) => name === "ElseifClause").map(children);
    const last = rest.find(({ name }) => name === "ElseClause");
    /** @type {Record<string, any>} */
    const inputs = { IF0: this.#socket(condition), ...this.#bodies({ DO0: rest.filter(isBody) }) };
    others.forEach(([, test, , ...inside], index) => {
      Object.assign(inputs, { [`IF${index + 1}`]: this.#socket(test) }, this.#bodies({ [`DO${index + 1}`]: inside }));
    });
    if (last !== undefined) Object.assign(inputs, this.#bodies({ ELSE: children(last).slice(1) }));
    const extra = { ...(others.length > 0 && { elseIfCount: others.length }), ...(last && { hasElse: true }) };
    return { type: "controls_if", inputs, ...(Object.keys(extra).length > 0 && { extraState: extra }) };
  }

  /** @param {Node} node @param {readonly Node[]} parts @returns {BlockState} */
  #for(node, [, variable, , ...rest]) {
    const at = rest.findIndex(({ name }) => name === "do");
    const bounds = rest.slice(0, at).filter(({ name }) => name !== ":" && name !== "step");
    const [FROM, TO, step = 1] = bounds.map((bound) => this.#constant(bound));
    if (step !== (FROM > TO ? -1 : 1)) throw new NoBlock(node);
    const fields = { ITER: this.#field(this.#single(variable)), FROM, TO };
    return { type: "thymio_for", fields, inputs: this.#bodies({ DO: rest.slice(at + 1, -1) }) };
  }

  /** @param {Node} node @param {readonly Node[]} parts @returns {BlockState[]} */
  #definition(node, parts) {
    const name = this.#text(parts[1]);
    const at = parts.findIndex((part) => part.name === "AssignOp");
    const values = at < 0 ? [] : parts.slice(at + 1);
    const head = parts.slice(2, at < 0 ? undefined : at).filter((part) => !["[", "]"].includes(part.name));
    if (head.length === 0) {
      this.#sizes.set(name, 0);
      if (values.length > 1 || values[0]?.name === "List") throw new NoBlock(node);
      return values.map((value) => this.#setter(name, this.#value(value)));
    }
    const size = this.#constant(head[0]);
    this.#sizes.set(name, size);
    const items = values.flatMap((value) => (value.name === "List" ? elements(value) : [value]));
    return [
      { type: "thymio_declare_array", fields: { VAR: this.#field(name), SIZE: String(size) } },
      ...items.map((value, index) => this.#element(name, index, this.#value(value))),
    ];
  }

  /** @param {readonly Node[]} parts @returns {BlockState} */
  #assignment([variable, operator, right]) {
    const sign = this.#text(operator);
    /** @type {BlockState} */ let value;
    if (sign === "=") value = this.#value(right);
    else {
      const other = operator.name === "StepOp" ? number(1) : this.#value(right);
      value = this.#operation(["++", "--"].includes(sign) ? sign[0] : sign.slice(0, -1), this.#value(variable), other);
    }
    const target = TARGETS[this.#text(variable)];
    if (target !== undefined) {
      const [type, fields] = target;
      return { type, ...(fields && { fields }), inputs: { VALUE: plug(value) } };
    }
    const [name, index] = this.#place(variable);
    if (index === null) return this.#setter(this.#single(variable), value);
    const inputs = { INDEX: plug(index), VALUE: plug(value) };
    return { type: "thymio_set_array", fields: { VAR: this.#field(name) }, inputs };
  }

  /** @param {Node} node @param {readonly Node[]} parts @returns {BlockState[]} */
  #call(node, [, name, ...rest]) {
    const called = this.#text(name);
    const values = rest.filter((part) => !["(", ")", ","].includes(part.name));
    if (called === "math.copy") return this.#copy(node, values);
    if (called === "sound.system") {
      const sound = this.#constant(values[0]);
      if (sound === -1) return [{ type: "thymio_sound_stop" }];
      return [{ type: "thymio_sound_system", fields: { SOUND: String(sound) } }];
    }
    if (called === "prox.comm.enable") {
      const MODE = { 0: "DISABLE", 1: "ENABLE" }[this.#constant(values[0])];
      if (MODE === undefined) throw new NoBlock(node);
      return [{ type: "thymio_communication", fields: { MODE } }];
    }
    if (called in WITH_VARIABLE) {
      const [variable, ...others] = values;
      const type = WITH_VARIABLE[called];
      return [{ type, fields: { VAR: this.#field(this.#known(variable)) }, inputs: this.#inputs(type, others, node) }];
    }
    const found = FUNCTIONS[called];
    if (found === undefined) throw new NoBlock(node);
    const [type, fields] = found;
    return [{ type, ...(fields && { fields }), inputs: this.#inputs(type, values, node) }];
  }

  /** Values for the inputs of a block. @param {string} type @param {readonly Node[]} values @param {Node} node */
  #inputs(type, values, node) {
    const names = (BLOCKS.get(type)?.args ?? []).filter(({ kind }) => kind === "value").map(({ name }) => name);
    if (names.length !== values.length) throw new NoBlock(node);
    return Object.fromEntries(names.map((name, index) => [name, this.#socket(values[index])]));
  }

  /** A copy of a list as one statement for each number. @param {Node} node @param {readonly Node[]} values */
  #copy(node, [to, from]) {
    const [name, first, count] = this.#range(to);
    if (from.name === "List") {
      const constants = elements(from).map((each) => this.#constant(each));
      if (constants.length !== count) throw new NoBlock(node);
      return constants.map((value, index) => this.#element(name, first + index, number(value)));
    }
    const [source, begin, length] = this.#range(from);
    if (length !== count || source === name) throw new NoBlock(node);
    return Array.from({ length: count }, (_, index) => {
      const inputs = { INDEX: plug(number(begin + index)) };
      const value = { type: "thymio_get_array", fields: { VAR: this.#field(source) }, inputs };
      return this.#element(name, first + index, value);
    });
  }

  /** Name, first index and count of a list or a part of it. @param {Node} node @returns {[string, number, number]} */
  #range(node) {
    const name = this.#known(node);
    const bounds = children(node).filter((part) => !["VariableName", "[", "]", ":"].includes(part.name));
    if (bounds.length === 0) return [name, 0, this.#sizes.get(name) ?? 0];
    const [first, last = first] = bounds.map((bound) => this.#constant(bound));
    return [name, first, last - first + 1];
  }

  /** @param {Node} node @returns {BlockState} */
  #value(node) {
    const parts = children(node);
    switch (node.name) {
      case "Number":
        return number(this.#constant(node));
      case "Variable":
        return this.#reading(node);
      case "Parenthesized":
        return this.#value(parts[1]);
      case "Unary":
        return this.#unary(parts);
      case "Binary": {
        const button = PRESSED.exec(this.#text(node));
        if (button !== null) return { type: "thymio_button_pressed", fields: { BUTTON: button[1] } };
        return this.#operation(this.#text(parts[1]), this.#value(parts[0]), this.#value(parts[2]));
      }
      default:
        throw new NoBlock(node);
    }
  }

  /** @param {readonly Node[]} parts @returns {BlockState} */
  #unary([operator, inner]) {
    const sign = this.#text(operator);
    if (sign === "-" && inner.name === "Number") return number(-this.#constant(inner));
    if (sign === "not") return { type: "logic_negate", inputs: { BOOL: this.#socket(inner) } };
    return { type: "thymio_unary", fields: { OP: sign }, inputs: { VALUE: this.#socket(inner) } };
  }

  /** @param {string} sign @param {BlockState} left @param {BlockState} right @returns {BlockState} */
  #operation(sign, left, right) {
    const inputs = { A: plug(left), B: plug(right) };
    if (sign === "and" || sign === "or") return { type: "logic_operation", fields: { OP: sign.toUpperCase() }, inputs };
    if (sign in COMPARISONS) return { type: "thymio_compare", fields: { OP: COMPARISONS[sign] }, inputs };
    return { type: BITS.includes(sign) ? "thymio_binary" : "thymio_arithmetic", fields: { OP: sign }, inputs };
  }

  /** @param {Node} node @returns {BlockState} */
  #reading(node) {
    const found = READINGS.get(this.#text(node));
    if (found !== undefined) return /** @type {BlockState} */ (structuredClone(found));
    const [name, index] = this.#place(node);
    if (index === null) return { type: "variables_get", fields: { VAR: this.#field(this.#single(node)) } };
    return { type: "thymio_get_array", fields: { VAR: this.#field(name) }, inputs: { INDEX: plug(index) } };
  }

  /** Name and index of a variable of the program. @param {Node} node @returns {[string, BlockState | null]} */
  #place(node) {
    const parts = children(node).filter((part) => !["VariableName", "[", "]"].includes(part.name));
    if (parts.length > 1) throw new NoBlock(node);
    return [this.#known(node), parts.length === 0 ? null : this.#value(parts[0])];
  }

  /** The name of a variable of the program. @param {Node} node */
  #known(node) {
    const name = node.name === "Variable" ? this.#text(children(node)[0]) : "";
    if (!this.#sizes.has(name)) throw new NoBlock(node);
    return name;
  }

  /** The name of a variable of the program that is one number. @param {Node} node */
  #single(node) {
    const name = this.#known(node);
    if (this.#sizes.get(name) !== 0) throw new NoBlock(node);
    return name;
  }

  /** @param {Node} node */
  #constant(node) {
    const value = Number(this.#text(node).replaceAll(" ", ""));
    if (!Number.isInteger(value)) throw new NoBlock(node);
    return value;
  }

  /** @param {string} name @param {BlockState} value @returns {BlockState} */
  #setter(name, value) {
    return { type: "variables_set", fields: { VAR: this.#field(name) }, inputs: { VALUE: plug(value) } };
  }

  /** @param {string} name @param {number} index @param {BlockState} value @returns {BlockState} */
  #element(name, index, value) {
    const inputs = { INDEX: plug(number(index)), VALUE: plug(value) };
    return { type: "thymio_set_array", fields: { VAR: this.#field(name) }, inputs };
  }

  /** A field that names a variable: its id is its name. @param {string} name */
  #field(name) {
    return { id: name };
  }

  /** @param {Node} node */
  #socket(node) {
    return plug(this.#value(node));
  }

  /** @param {Node} node */
  #text({ from, to }) {
    return this.code.slice(from, to);
  }
}

/** Without comments. A mistake in the text has no block. @param {Node} node @returns {Node[]} */
function children(node) {
  const all = [];
  for (let each = node.firstChild; each !== null; each = each.nextSibling) {
    if (each.type.isError) throw new NoBlock(each);
    if (!each.name.endsWith("Comment")) all.push(each);
  }
  return all;
}

/** @param {Node} list */
const elements = (list) => children(list).filter(({ name }) => !["[", "]", ","].includes(name));

/** @param {number} value @returns {BlockState} */
const number = (value) => ({ type: "math_number", fields: { NUM: value } });

/** A number is a shadow, as in a new block. @param {BlockState} block */
const plug = (block) => (block.type === "math_number" ? { shadow: block } : { block });

/** The height of a block and of those below, in statements. @param {BlockState | undefined} block @returns {number} */
function sizeOf(block) {
  if (block === undefined) return 0;
  const inside = Object.values(block.inputs ?? {}).map((socket) => socket.block);
  const isStatement = ["statement", "hat"].includes(BLOCKS.get(block.type)?.shape ?? "");
  const own = isStatement ? 1 : block.type === "logic_operation" ? 0.5 : 0;
  return own + [...inside, block.next?.block].reduce((sum, each) => sum + sizeOf(each), 0);
}
