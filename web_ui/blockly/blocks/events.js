// Hats: what the robot reacts to.

import { BUTTONS, GROUND, GROUND_MODES, HORIZONTAL, PROXIMITY_MODES, ground, proximity } from "./robot.js";
import { body, choice } from "./spec.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */
/** @typedef {import("./spec.js").Arg} Arg */
/** @typedef {import("./spec.js").Generator} Generator */
/** @typedef {import("./spec.js").BlockState} BlockState */

/**
 * A hat whose statements run when a comparison becomes true.
 *
 * @param {string} type
 * @param {Arg[]} fields
 * @param {(g: Generator, block: BlockState) => [event: string, comparison: string]} trigger
 * @returns {BlockSpec}
 */
function edgeHat(type, fields, trigger) {
  return {
    type,
    shape: "hat",
    style: "event_blocks",
    args: [...fields, body("HANDLER")],
    hat(g, block) {
      const [event, comparison] = trigger(g, block);
      const lines = [g.line(block, `when ${comparison} do`), ...g.body(block, "HANDLER"), g.line(block, "end")];
      return { event, lines };
    },
  };
}

/**
 * A hat whose statements run at each event.
 *
 * @param {string} type
 * @param {string} event  the event, or the field that names it
 * @param {Arg[]} [fields]
 * @returns {BlockSpec}
 */
function eventHat(type, event, fields = []) {
  return {
    type,
    shape: "hat",
    style: "event_blocks",
    args: [...fields, body("HANDLER")],
    hat: (g, block) => ({
      event: fields.length > 0 ? g.field(block, event) : event,
      lines: g.statements(block, "HANDLER"),
    }),
  };
}

/** @param {string} set @param {readonly (readonly [word: string, value: string])[]} options */
const eventChoice = (set, options) => [choice("EVENT", set, options)];

/** @type {readonly BlockSpec[]} */
export const EVENTS = [
  edgeHat(
    "thymio_event_button",
    [
      choice("BUTTON", "button", BUTTONS),
      choice("MODE", "press", [
        ["pressed", "PRESS"],
        ["released", "RELEASE"],
      ]),
    ],
    (g, block) => {
      const button = g.field(block, "BUTTON");
      return [button, `${button} == ${g.field(block, "MODE") === "RELEASE" ? 0 : 1}`];
    },
  ),
  edgeHat(
    "thymio_event_prox",
    [choice("SENSOR", "sensor", HORIZONTAL), choice("MODE", "near", PROXIMITY_MODES)],
    (g, block) => ["prox", proximity(g.field(block, "SENSOR"), g.field(block, "MODE"))],
  ),
  edgeHat(
    "thymio_event_prox_ground",
    [choice("SENSOR", "sensor", GROUND), choice("MODE", "ground", GROUND_MODES)],
    (g, block) => ["prox", ground(g.field(block, "SENSOR"), g.field(block, "MODE"))],
  ),
  eventHat("thymio_event_shock", "tap"),
  eventHat(
    "thymio_event_timer",
    "EVENT",
    eventChoice("timer", [
      ["first", "timer0"],
      ["second", "timer1"],
    ]),
  ),
  eventHat(
    "thymio_event_sound",
    "EVENT",
    eventChoice("sound_event", [
      ["noise", "mic"],
      ["finished", "sound.finished"],
    ]),
  ),
  eventHat(
    "thymio_event_receive",
    "EVENT",
    eventChoice("message", [
      ["robot", "prox.comm"],
      ["remote_control", "rc5"],
    ]),
  ),
  eventHat(
    "thymio_event_update",
    "EVENT",
    eventChoice("update", [
      ["buttons", "buttons"],
      ["proximity", "prox"],
      ["temperature", "temperature"],
      ["acceleration", "acc"],
      ["motors", "motor"],
    ]),
  ),
];
