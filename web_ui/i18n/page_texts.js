// The texts that the page needs at once, by file; lazy parts import their own.

import examples from "./examples.texts.js";
import page from "./page.texts.js";
import playground from "./playground.texts.js";
import program from "./program.texts.js";
import robot from "./robot.texts.js";
import stage from "./stage.texts.js";

export const TEXTS = { examples, page, playground, program, robot, stage };

/** @typedef {keyof typeof TEXTS} TextFile */
