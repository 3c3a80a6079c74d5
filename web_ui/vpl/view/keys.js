// The keyboard in the rows: arrows move between blocks, Delete removes, Ctrl and arrows move rows and actions.

import { isSlot, spotOf } from "./place.js";

/** @typedef {import("./place.js").Spot} Spot */
/**
 * @typedef {object} KeyActions
 * @property {(place: string) => void} go             to another place
 * @property {(spot: Spot) => void} remove
 * @property {(spot: Spot, by: -1 | 1) => void} moveRow
 * @property {(spot: Spot, by: -1 | 1) => void} moveBlock
 * @property {(spot: Spot) => void} copyRow
 * @property {(spot: Spot) => void} copy
 * @property {(spot: Spot) => void} paste
 * @property {() => void} undo
 * @property {() => void} redo
 * @property {() => boolean} cancel                   returns whether there was something to cancel
 */

/** @param {HTMLElement} element  the view @param {HTMLElement} rows @param {KeyActions} actions */
export function watchKeys(element, rows, actions) {
  element.addEventListener("keydown", (event) => {
    const { key, shiftKey, altKey } = event;
    const ctrl = event.ctrlKey || event.metaKey;
    if (altKey) return;
    const spot = rows.contains(/** @type {Node} */ (event.target)) ? spotOf(event.target) : null;
    if (!act(key.length === 1 ? key.toLowerCase() : key, ctrl, shiftKey, spot)) return;
    event.preventDefault();
    event.stopPropagation();
  });

  /** @param {string} key @param {boolean} ctrl @param {boolean} shift @param {Spot | null} spot */
  const act = (key, ctrl, shift, spot) => {
    if (ctrl && key === "z") shift ? actions.redo() : actions.undo();
    else if (ctrl && key === "y") actions.redo();
    else if (key === "Escape") return actions.cancel();
    else if (spot === null) return false;
    else if (ctrl) return withCtrl(key, spot);
    else if (key === "Delete" || key === "Backspace") actions.remove(spot);
    else return move(key, spot);
    return true;
  };

  /** @param {string} key @param {Spot} spot */
  const withCtrl = (key, spot) => {
    if (key === "ArrowUp") actions.moveRow(spot, -1);
    else if (key === "ArrowDown") actions.moveRow(spot, 1);
    else if (key === "ArrowLeft" && isSlot(spot)) actions.moveBlock(spot, -1);
    else if (key === "ArrowRight" && isSlot(spot)) actions.moveBlock(spot, 1);
    else if (key === "c") actions.copy(spot);
    else if (key === "v") actions.paste(spot);
    else if (key === "d") actions.copyRow(spot);
    else return false;
    return true;
  };

  /** @param {string} key @param {Spot} spot */
  const move = (key, spot) => {
    const places = /** @type {HTMLElement[]} */ ([...rows.querySelectorAll("[data-place]")]).map((each) => ({
      place: each.dataset.place ?? "",
      ...spotOf(each),
    }));
    const mine = places.filter(({ row }) => row === spot.row);
    const at = mine.findIndex(({ slot, index }) => slot === spot.slot && index === spot.index);
    /** @param {number} row */
    const inRow = (row) => {
      const there = places.filter((each) => each.row === row);
      const same = there.filter(({ slot }) => slot === spot.slot);
      return same[Math.min(spot.index, same.length - 1)] ?? there[Math.min(at, there.length - 1)];
    };
    const lastRow = places.at(-1)?.row ?? 0;
    const target = {
      ArrowLeft: () => mine[at - 1],
      ArrowRight: () => mine[at + 1],
      ArrowUp: () => inRow(spot.row - 1),
      ArrowDown: () => inRow(spot.row + 1),
      Home: () => inRow(0),
      End: () => inRow(lastRow),
    }[key];
    if (target === undefined) return false;
    const found = target();
    if (found !== undefined) actions.go(found.place);
    return true;
  };
}
