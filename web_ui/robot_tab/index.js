// The panels of the tab "Robot". To add one: a file, and a line here.

import { robotPanel } from "./robot_panel.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const ROBOT_TAB = [robotPanel];
