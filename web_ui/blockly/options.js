// What `Blockly.inject` gets, apart from the theme.

import { RENDERERS } from "./themes.js";
import { toolbox } from "./toolbox.js";

/** @typedef {import("./toolbox.js").Look} Look */
/** @typedef {import("../i18n/index.js").Translate} Translate */

/** The blocks of Scratch are larger. @type {Record<Look, number>} */
const START_SCALES = { blockly: 0.9, scratch: 0.7 };

/** Blocks snap to a grid of this many pixels, as on the existing page. */
const GRID_PX = 25;

/**
 * @typedef {object} EditorOptions
 * @property {Translate} t  of blockly.json
 * @property {string} media  address of the folder of Blockly's pictures, which it would load from another host else
 * @property {ReadonlySet<string>} [hidden]  by a teacher's file
 * @property {boolean} [isNarrow]  whether there is little room beside the toolbox, as on phones
 * @property {boolean} [readOnly]
 */

/** @param {Look} look @param {EditorOptions} options */
export function injectOptions(look, { t, media, hidden = new Set(), isNarrow = false, readOnly = false }) {
  return {
    toolbox: toolbox(look, t, hidden),
    horizontalLayout: isNarrow,
    toolboxPosition: isNarrow ? "end" : "start",
    renderer: RENDERERS[look],
    media,
    readOnly,
    grid: { spacing: GRID_PX, length: 3, snap: true },
    zoom: { controls: true, wheel: true, startScale: START_SCALES[look], minScale: 0.25, maxScale: 4 },
    collapse: true,
    comments: true,
    disable: true,
    sounds: false,
    trashcan: false, // blocks are dragged back to the toolbox
  };
}
