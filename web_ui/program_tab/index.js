// The panels of the tab "Program" that are there before its languages are loaded. To add one: a file, and a line here.

import { programNews } from "./program_news.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const PROGRAM_TAB = [programNews];
