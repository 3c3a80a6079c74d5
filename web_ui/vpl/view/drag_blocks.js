// Drags between palettes and rows: what is dragged, where it may be dropped, what a drop does.

import { makeBlock } from "../blocks.js";
import { blockAt } from "../edits.js";
import { watchDrags } from "./drag.js";
import { draggedOut, dropped } from "./dropping.js";
import { picture } from "./picture.js";
import { isSlot, placeOf, spotOf } from "./place.js";

/** Beyond the last block of a slot. */
const END = 99;

/**
 * Returns a function that ends this.
 *
 * @param {object} options
 * @param {HTMLElement} options.element   the view
 * @param {HTMLElement} options.rows
 * @param {import("./commands.js").VplCommands} options.commands
 * @param {() => void} options.started
 */
export function dragBlocks({ element, rows, commands, started }) {
  const { editing } = commands;
  /** @type {import("./dropping.js").Dragged | null} */ let dragged = null;
  /** @type {Element | null} the row below the pointer */ let below = null;

  /**
   * What is below the pointer: a row, its place for blocks, or what is beside the rows.
   *
   * @param {number} x
   * @param {number} y
   */
  const at = (x, y) => {
    const target = document.elementFromPoint(x, y);
    const row = target?.closest("[data-row]") ?? null;
    const isOut = target !== null && target.closest(".vpl-palette") !== null;
    if (target === null || !rows.contains(target)) return { row: null, spot: null, isOut };
    const index = row instanceof HTMLElement ? Number(row.dataset.row) : editing.program.rows.length - 1;
    /** @type {import("./place.js").Spot["slot"]} */
    const slot = target.closest(".vpl-conditions") === null ? "row" : "conditions";
    return { row, spot: spotOf(target) ?? { row: index, slot, index: END }, isOut };
  };

  /** @param {Element | null} row @param {string} [look] */
  const mark = (row, look) => {
    if (below !== row) below?.classList.remove("vpl-drop", "vpl-drop-no");
    below = row;
    row?.classList.toggle("vpl-drop", look === "vpl-drop");
    row?.classList.toggle("vpl-drop-no", look === "vpl-drop-no");
  };

  return watchDrags(element, rows, {
    start(source) {
      const name = source.dataset.newBlock;
      const spot = spotOf(source);
      started();
      dragged = name ?? spot;
      if (name !== undefined) return picture(makeBlock(name));
      if (spot === null) return null;
      const block = isSlot(spot) ? blockAt(editing.program, placeOf(spot)) : null;
      return block === null ? (source.closest("[data-row]")?.outerHTML ?? null) : picture(block);
    },
    over(x, y, copy) {
      const { row, spot } = at(x, y);
      if (dragged === null || spot === null) return mark(null);
      mark(row, dropped(editing.program, dragged, spot, copy).reason === null ? "vpl-drop" : "vpl-drop-no");
    },
    drop(x, y, copy) {
      const { spot, isOut } = at(x, y);
      if (dragged === null) return;
      if (spot !== null) commands.apply(dropped(editing.program, dragged, spot, copy));
      else if (isOut && !copy) commands.edit(draggedOut(editing.program, dragged));
    },
    end() {
      mark(null);
      dragged = null;
    },
  });
}
