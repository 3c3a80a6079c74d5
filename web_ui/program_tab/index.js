// The panels of the tab "Program", above the editor. To add one: a file, and a line here.

import { programPanel } from "./program_card.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const PROGRAM_TAB = [programPanel];
