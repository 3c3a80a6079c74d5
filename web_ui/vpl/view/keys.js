// The keyboard in the rows: arrows move between blocks, Delete removes, Ctrl and arrows move rows and actions.

import { isSlot, spotOf, written } from "./place.js";

/** @typedef {import("./place.js").Spot} Spot */

/**
 * @param {HTMLElement} element   the view
 * @param {import("./rows.js").RowList} rows
 * @param {import("./commands.js").VplCommands} commands
 */
export function watchKeys(element, rows, commands) {
  const { editing } = commands;
  element.addEventListener("keydown", (event) => {
    const { key, shiftKey, altKey } = event;
    const ctrl = event.ctrlKey || event.metaKey;
    if (altKey) return;
    const spot = rows.element.contains(/** @type {Node} */ (event.target)) ? spotOf(event.target) : null;
    if (!act(key.length === 1 ? key.toLowerCase() : key, ctrl, shiftKey, spot)) return;
    event.preventDefault();
    event.stopPropagation();
  });

  /** @param {string} key @param {boolean} ctrl @param {boolean} shift @param {Spot | null} spot */
  const act = (key, ctrl, shift, spot) => {
    if (ctrl && (key === "y" || (key === "z" && shift))) commands.redo();
    else if (ctrl && key === "z") commands.undo();
    else if (key === "Escape") return commands.cancel();
    else if (spot === null) return false;
    else if (ctrl) return withCtrl(key, spot);
    else if (key === "Delete" || key === "Backspace") {
      commands.remove(spot);
      focus(spot);
    } else return go(key, spot);
    return true;
  };

  /** Draw, then focus a place. @param {Spot} spot */
  const focus = (spot) => {
    commands.draw();
    rows.focus(written(spot));
  };

  /** @param {string} key @param {Spot} spot */
  const withCtrl = (key, spot) => {
    const by = key === "ArrowUp" || key === "ArrowLeft" ? -1 : 1;
    if (key === "ArrowUp" || key === "ArrowDown") {
      commands.moveRow(spot.row, spot.row + by);
      focus({ ...spot, row: editing.selected ?? spot.row });
    } else if ((key === "ArrowLeft" || key === "ArrowRight") && isSlot(spot)) {
      commands.moveInRow(spot, by);
      focus({ ...spot, index: Math.max(spot.index + by, 0) });
    } else if (key === "c") commands.copy(spot);
    else if (key === "v") {
      commands.paste(spot);
      focus(spot);
    } else if (key === "d") {
      if (spot.row < editing.program.rows.length - 1) commands.actOnRow("copy", spot.row);
    } else return false;
    return true;
  };

  /** @param {string} key @param {Spot} spot */
  const go = (key, spot) => {
    const all = /** @type {HTMLElement[]} */ ([...rows.element.querySelectorAll("[data-place]")]);
    const spots = all.map((each) => /** @type {Spot} */ (spotOf(each)));
    const mine = spots.filter(({ row }) => row === spot.row);
    const at = mine.findIndex(({ slot, index }) => slot === spot.slot && index === spot.index);
    /** The place in another row that is most like this one. @param {number} row */
    const inRow = (row) => {
      const there = spots.filter((each) => each.row === row);
      const same = there.filter(({ slot }) => slot === spot.slot);
      return same[Math.min(spot.index, same.length - 1)] ?? there[Math.min(at, there.length - 1)];
    };
    /** @type {Record<string, () => Spot | undefined>} */
    const targets = {
      ArrowLeft: () => mine[at - 1],
      ArrowRight: () => mine[at + 1],
      ArrowUp: () => inRow(spot.row - 1),
      ArrowDown: () => inRow(spot.row + 1),
      Home: () => inRow(0),
      End: () => inRow(spots.at(-1)?.row ?? 0),
    };
    const target = targets[key];
    if (target === undefined) return false;
    const found = target();
    if (found !== undefined) rows.focus(written(found));
    return true;
  };
}
