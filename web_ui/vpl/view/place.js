// Places in the rows as they are written into the elements of the page: `data-place="2 actions 1"`. Beside the slots of a
// row, its number and its bin are places, too.

/** @typedef {import("../program.js").Place["slot"]} Slot */
/** @typedef {{ row: number, slot: Slot | "row" | "remove", index: number }} Spot */

/** @param {Spot} spot */
export function written({ row, slot, index }) {
  return `${row} ${slot} ${index}`;
}

/**
 * The place that is written into an element or the nearest one around it; null if there is none.
 *
 * @param {EventTarget | null} target
 */
export function spotOf(target) {
  const element = target instanceof Element ? target.closest("[data-place]") : null;
  const text = element instanceof HTMLElement ? element.dataset.place : undefined;
  if (text === undefined) return null;
  const [row, slot, index] = text.split(" ");
  return { row: Number(row), slot: /** @type {Spot["slot"]} */ (slot), index: Number(index) };
}

/** Whether a place is one of a block. @param {Spot} spot @returns {spot is Spot & { slot: Slot }} */
export function isSlot(spot) {
  return spot.slot !== "row" && spot.slot !== "remove";
}

/** The place of a block as the edits name it. @param {Spot} spot @returns {import("../program.js").Place} */
export function placeOf({ row, slot, index }) {
  return { row, slot: /** @type {Slot} */ (slot), index };
}
