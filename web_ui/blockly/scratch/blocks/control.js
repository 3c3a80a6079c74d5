// Hats of scripts, waiting, loops and messages.

import { body, choice, condition, number, seconds, text } from "../../blocks/spec.js";
import { NONE, UNARY } from "../../precedence.js";
import { BUTTON_MENU } from "./sensing.js";

/** @typedef {import("../../blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("../../blocks/spec.js").Arg} Arg */
/** @typedef {import("../../blocks/spec.js").Line} Line */
/** @typedef {import("../../blocks/spec.js").Generator} Generator */
/** @typedef {import("../../state.js").BlockState} BlockState */

/**
 * @param {string} type
 * @param {Arg[]} args
 * @param {NonNullable<BlockSpec["trigger"]>} trigger
 * @returns {BlockSpec}
 */
const hat = (type, args, trigger) => ({ type, shape: "hat", style: "scratch_event_blocks", args, trigger });

/** @param {string} type @param {Arg[]} args @param {NonNullable<BlockSpec["step"]>} step @returns {BlockSpec} */
const step = (type, args, step) => ({ type, shape: "statement", style: "control_blocks", args, step, waits: true });

/**
 * A hat that starts its script when a comparison becomes true.
 *
 * @param {string} type
 * @param {Arg[]} args
 * @param {(g: Generator, block: BlockState) => [event: string, comparison: string]} when
 */
const sensorHat = (type, args, when) =>
  hat(type, args, (runner, block, start) => {
    const [event, comparison] = when(runner.g, block);
    const inner = start.map((line) => ({ ...line, text: `\t${line.text}` }));
    runner.g.handle(event, [runner.g.line(block, `when ${comparison} do`), ...inner, runner.g.line(block, "end")]);
  });

/** @param {string} name @param {readonly number[]} indices */
const sum = (name, indices) => indices.map((index) => `${name}[${index}]`).join(" + ");

/**
 * What the sensors of a side add up to, and from where on they detect something.
 *
 * @type {Record<string, [string, number]>}
 */
const SIDES = {
  front: [sum("prox.horizontal", [0, 1, 2, 3, 4]), 0],
  back: [sum("prox.horizontal", [5, 6]), 0],
  ground: [sum("prox.ground.delta", [0, 1]), 50],
};
const SIDE = choice(
  "S",
  "side",
  Object.keys(SIDES).map((side) => [side, side]),
);

/** The sensors of a side for the hat with a threshold. @type {Record<string, readonly string[]>} */
const PARTS = {
  left: ["prox.horizontal[0]", "prox.horizontal[1]"],
  front: ["prox.horizontal[1]", "prox.horizontal[2]", "prox.horizontal[3]"],
  right: ["prox.horizontal[3]", "prox.horizontal[4]"],
  back: ["prox.horizontal[5]", "prox.horizontal[6]"],
  ground: ["prox.ground.delta[0]", "prox.ground.delta[1]"],
};
/** @type {Record<string, { ground: number, other: number }>} */
const THRESHOLDS = { near: { ground: 600, other: 3000 }, far: { ground: 50, other: 1000 } };

/**
 * The scripts that the message of a block starts.
 *
 * @param {Generator} g
 * @param {BlockState} block
 * @returns {Line[]}
 */
const send = (g, block) =>
  g.scripts.startedBy(g.field(block, "MESSAGE")).map((script) => g.line(block, `${script} = 1`));

/** @type {readonly BlockSpec[]} */
export const CONTROL = [
  hat("event_whenflagclicked", [], (runner, _block, start) => runner.starts.push(...start)),
  sensorHat("thymio_whenButton", [choice("B", "button", BUTTON_MENU)], (g, block) => {
    const word = BUTTON_MENU.find(([, value]) => value === g.field(block, "B"))?.[0] ?? "center";
    return [`button.${word}`, `button.${word} == 1`];
  }),
  sensorHat("thymio_touching", [SIDE], (g, block) => {
    const [total, threshold] = SIDES[g.field(block, "S")];
    return ["prox", `${total} > ${threshold}`];
  }),
  sensorHat("thymio_notouching", [SIDE], (g, block) => {
    const [total, threshold] = SIDES[g.field(block, "S")];
    return ["prox", `${total} <= ${threshold}`];
  }),
  sensorHat(
    "thymio_touchingThreshold",
    [
      choice(
        "S",
        "side",
        Object.keys(PARTS).map((side) => [side, side]),
        "front",
      ),
      choice("N", "distance", [
        ["near", "near"],
        ["far", "far"],
      ]),
    ],
    (g, block) => {
      const side = g.field(block, "S");
      const threshold = THRESHOLDS[g.field(block, "N")][side === "ground" ? "ground" : "other"];
      const [first, ...others] = PARTS[side].map((sensor) => `${sensor} > ${threshold}`);
      return ["prox", others.reduce((all, each, index) => `${index > 0 ? `(${all})` : all} or ${each}`, first)];
    },
  ),
  hat("thymio_bump", [], (runner, _block, start) => runner.g.handle("tap", start)),
  hat("thymio_soundDetected", [], (runner, block, start) => {
    runner.starts.push(runner.g.line(block, "mic.threshold = 250"));
    runner.g.handle("mic", start);
  }),
  hat("event_whenbroadcastreceived", [text("MESSAGE", "message")], () => {}), // started by the blocks that send
  {
    type: "event_broadcast",
    shape: "statement",
    style: "scratch_event_blocks",
    args: [text("MESSAGE", "message")],
    statement: send,
  },
  {
    ...step("event_broadcastandwait", [text("MESSAGE", "message")], (script, block) => {
      const started = script.g.scripts.startedBy(script.g.field(block, "MESSAGE"));
      for (const { text: line } of send(script.g, block)) script.line(block, line);
      if (started.length > 0) {
        const running = started.reduce((all, each) => `(${all}) + ${each}`);
        script.waitUntil(block, `${running} == 0`);
      }
    }),
    style: "scratch_event_blocks",
  },
  step("control_wait", [seconds("DURATION", 1)], (script, block) =>
    script.wait(block, script.steps(block, "DURATION")),
  ),
  step("control_repeat", [number("TIMES", 10), body("SUBSTACK")], (script, block) =>
    script.repeat(block, script.g.number(block, "TIMES"), () => script.statements(block, "SUBSTACK")),
  ),
  step("control_forever", [body("SUBSTACK")], (script, block) =>
    script.loop(block, null, () => script.statements(block, "SUBSTACK")),
  ),
  step("control_wait_until", [condition("CONDITION")], (script, block) =>
    script.waitUntil(block, script.g.condition(block, "CONDITION", NONE)),
  ),
  step("control_repeat_until", [condition("CONDITION"), body("SUBSTACK")], (script, block) =>
    script.loop(block, script.g.condition(block, "CONDITION", NONE), () => script.statements(block, "SUBSTACK")),
  ),
  step(
    "control_stop",
    [
      choice("STOP_OPTION", "stop", [
        ["all", "all"],
        ["this_script", "this script"],
        ["other_scripts", "other scripts in sprite"],
      ]),
    ],
    (script, block) => {
      const option = script.g.field(block, "STOP_OPTION");
      if (option !== "this script") {
        for (const { at } of script.runner.scripts) if (at !== script.at) script.line(block, `${at} = 0`);
      }
      if (option !== "other scripts in sprite") script.stop(block);
    },
  ),
  {
    type: "data_changevariableby",
    shape: "statement",
    style: "variable_blocks",
    args: [{ kind: "variable", name: "VARIABLE", initial: "speed" }, number("VALUE", 1)],
    statement(g, block) {
      const name = g.scalar(block, "VARIABLE");
      return [g.line(block, `${name} = ${name} + ${g.number(block, "VALUE", UNARY)}`)];
    },
  },
];
