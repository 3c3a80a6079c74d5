// The panels of the tab "Playground" while nothing is built. To add one: a file, and a line here.

import { currentPanel } from "./current.js";
import { galleryPanel } from "./gallery.js";
import { ownPanel } from "./own.js";

/** @type {import("../shell/context.js").CreatePanel[]} */
export const PLAYGROUND_TAB = [currentPanel, ownPanel, galleryPanel];
