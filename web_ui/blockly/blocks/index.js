// All blocks by type.

import { SCRATCH } from "../scratch/blocks/index.js";
import { ACTUATORS } from "./actuators.js";
import { EVENTS } from "./events.js";
import { LED_BLOCKS } from "./leds.js";
import { LOGIC, LOOPS } from "./logic.js";
import { MATH } from "./math.js";
import { NATIVES } from "./natives.js";
import { SENSORS } from "./sensors.js";
import { SUBROUTINES, VARIABLES } from "./variables.js";

/** @typedef {import("./spec.js").BlockSpec} BlockSpec */

/** @type {readonly BlockSpec[]} */
export const THYMIO = [
  ...EVENTS,
  ...ACTUATORS,
  ...LED_BLOCKS,
  ...SENSORS,
  ...LOGIC,
  ...LOOPS,
  ...MATH,
  ...NATIVES,
  ...VARIABLES,
  ...SUBROUTINES,
];

/** @type {ReadonlyMap<string, BlockSpec>} */
export const BLOCKS = new Map([...THYMIO, ...SCRATCH].map((spec) => [spec.type, spec]));

/** The inputs of a block that take statements. @param {BlockSpec} spec */
export const bodies = (spec) => spec.args.filter(({ kind }) => kind === "body").map(({ name }) => name);
