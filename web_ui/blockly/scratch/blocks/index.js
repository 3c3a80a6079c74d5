// The blocks of the Scratch look, by their names in Scratch's files.

import { CONTROL } from "./control.js";
import { LIGHTS } from "./lights.js";
import { MOTION } from "./motion.js";
import { SENSING } from "./sensing.js";

/** @type {readonly import("../../blocks/spec.js").BlockSpec[]} */
export const SCRATCH = [...CONTROL, ...MOTION, ...LIGHTS, ...SENSING];
