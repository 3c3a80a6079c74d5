// Blocks that move the robot. `move`, `turn` and `arc` go on with the next block when the move is over.

import { choice, number, numberValue, renamed, seconds } from "../../blocks/spec.js";
import { UNARY } from "../../precedence.js";
import { HALF_TRACK } from "../library.js";

/** @typedef {import("../../blocks/spec.js").BlockSpec} BlockSpec */
/** @typedef {import("../../blocks/spec.js").Arg} Arg */
/** @typedef {import("../../state.js").BlockState} BlockState */
/** @typedef {import("../script.js").Script} Script */

/** The robot's units per mm/s, and the highest speed of `setMotor`. */
const UNITS = 3.2;
const FASTEST = 400;
/** The speed of the outer wheel on an arc, in mm/s: 400 of the robot's units. */
const ARC_SPEED = FASTEST / UNITS;
const SMALLEST_RADIUS = 100;

/**
 * @param {string} type
 * @param {Arg[]} args
 * @param {NonNullable<BlockSpec["statement"]>} statement
 * @returns {BlockSpec}
 */
const command = (type, args, statement) => ({ type, shape: "statement", style: "motion_blocks", args, statement });

/**
 * A move: `travel` sets move.left and move.right; the speed is in mm/s, or the time in steps.
 *
 * @param {string} type
 * @param {Arg[]} args
 * @param {(script: Script, block: BlockState) => void} travel
 * @param {(script: Script, block: BlockState) => void} pace  sets move.speed, and with speed 0 move.steps
 * @returns {BlockSpec}
 */
const move = (type, args, travel, pace) => ({
  type,
  shape: "statement",
  style: "motion_blocks",
  args,
  step(script, block) {
    script.runner.use("move.start");
    travel(script, block);
    pace(script, block);
    script.line(block, "callsub move.start");
    script.wait(block, "move.steps");
    script.line(block, "motor.left.target = 0");
    script.line(block, "motor.right.target = 0");
  },
});

/** @type {(script: Script, block: BlockState) => void} */
const straight = (script, block) => {
  script.line(block, `move.left = ${script.g.number(block, "N")}`);
  script.line(block, "move.right = move.left");
};

/** Clockwise, as Scratch turns. @type {(script: Script, block: BlockState) => void} */
const onTheSpot = (script, block) => {
  script.line(block, `call math.muldiv(move.left, ${script.g.number(block, "N")}, 785, 1000)`);
  script.line(block, "move.right = -move.left");
};

/** @type {(script: Script, block: BlockState) => void} */
const withTime = (script, block) => {
  script.line(block, "move.speed = 0");
  script.line(block, `move.steps = ${script.steps(block, "S")}`);
};

/** @type {(script: Script, block: BlockState) => void} */
const withSpeed = (script, block) => {
  script.line(block, `call math.clamp(move.speed, abs ${script.g.number(block, "S", UNARY)}, 1, 150)`);
};

/** @type {(script: Script, block: BlockState) => void} */
const moveSpeed = (script, block) => script.line(block, "call math.clamp(move.speed, abs move.left, 20, 150)");

/** @type {(script: Script, block: BlockState) => void} */
const turnSpeed = (script, block) => {
  for (const text of ["move.speed = 30", "if abs move.left > 45 then", "\tmove.speed = 60", "end"])
    script.line(block, text);
};

const MOTORS = choice("M", "motors", [
  ["all", "all"],
  ["left", "left"],
  ["right", "right"],
]);

/** @type {readonly BlockSpec[]} */
export const MOTION = [
  command("thymio_setMotor", [MOTORS, number("N", 50)], (g, block) => {
    const wheels = ["left", "right"].filter((wheel) => ["all", wheel].includes(g.field(block, "M")));
    const value = g.number(block, "N");
    const targets = wheels.map((wheel) => `motor.${wheel}.target`);
    if (/^-?\d+$/.test(value)) {
      const speed = Math.max(-FASTEST, Math.min(FASTEST, Math.round(Number(value) * UNITS)));
      return targets.map((target) => g.line(block, `${target} = ${speed}`));
    }
    return targets.flatMap((target) => [
      g.line(block, `call math.muldiv(${target}, ${value}, 16, 5)`),
      g.line(block, `call math.clamp(${target}, ${target}, -${FASTEST}, ${FASTEST})`),
    ]);
  }),
  command("thymio_stopMotors", [], (g, block) => [
    g.line(block, "motor.left.target = 0"),
    g.line(block, "motor.right.target = 0"),
  ]),
  move("thymio_move", [number("N", 50)], straight, moveSpeed),
  move("thymio_moveWithSpeed", [number("N", 50), number("S", 50)], straight, withSpeed),
  move("thymio_moveWithTime", [number("N", 50), seconds("S", 1)], straight, withTime),
  move("thymio_turn", [number("N", 45)], onTheSpot, turnSpeed),
  move("thymio_turnWithSpeed", [number("N", 90), number("S", 50)], onTheSpot, withSpeed),
  move("thymio_turnWithTime", [number("N", 90), seconds("S", 1)], onTheSpot, withTime),
  move(
    "thymio_arc",
    [number("R", 150), renamed("N", number("A", 45))],
    (script, block) => {
      const angle = script.g.number(block, "A", UNARY);
      script.line(block, `call math.max(move.longest, abs ${script.g.number(block, "R", UNARY)}, ${SMALLEST_RADIUS})`);
      // 1 rad is 57.3 degrees
      script.line(block, `call math.muldiv(move.left, move.longest + ${HALF_TRACK}, ${angle} * 10, 573)`);
      script.line(block, `call math.muldiv(move.right, move.longest - ${HALF_TRACK}, ${angle} * 10, 573)`);
    },
    (script, block) => script.line(block, `move.speed = ${ARC_SPEED}`),
  ),
  command(
    "thymio_setOdomoter",
    [renamed("D", number("N", 90)), renamed("X", number("O", 0)), renamed("Y", number("P", 0))],
    (g, block) => {
      g.scripts.use("odometer");
      return [
        g.line(block, `odo.direction = ${g.number(block, "N")}`),
        g.line(block, "call math.muldiv(odo.heading, odo.direction, 32767, 180)"),
        g.line(block, `odo.x = ${g.number(block, "O")}`),
        g.line(block, `odo.y = ${g.number(block, "P")}`),
      ];
    },
  ),
  {
    type: "thymio_odometer",
    shape: "Number",
    style: "motion_blocks",
    args: [
      choice("O", "odometer", [
        ["direction", "direction"],
        ["x", "x"],
        ["y", "y"],
      ]),
    ],
    value(g, block) {
      g.scripts.use("odometer");
      return numberValue(`odo.${g.field(block, "O")}`);
    },
  },
];
