// The picture of a block: SVG as text, without a DOM.

import { kindOf } from "../blocks.js";
import { ACTION_PICTURES } from "./actions.js";
import { EVENT_PICTURES } from "./events.js";
import { HEIGHT, outline, WIDTH } from "./shapes.js";

/** @typedef {import("../blocks.js").Block} Block */

/** What is inside the picture of a block. @param {Block} block */
export function drawing({ name, values }) {
  const draw = EVENT_PICTURES[name] ?? ACTION_PICTURES[name];
  return outline(kindOf(name).type) + draw(values);
}

/**
 * The picture, hidden from screen readers: the control that contains it has the block's sentence.
 *
 * @param {Block} block
 */
export function picture(block) {
  return `<svg class="vpl-picture" viewBox="0 0 ${WIDTH} ${HEIGHT}" aria-hidden="true">${drawing(block)}</svg>`;
}
