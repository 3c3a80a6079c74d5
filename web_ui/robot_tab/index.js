// The panels of the tab "Robot". To add one: a file, and a line here.

import { valuesPanel } from "./values_table.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const ROBOT_TAB = [valuesPanel];
