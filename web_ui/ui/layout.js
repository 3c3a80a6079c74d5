// The layout of the page by the size of the window. Pure.

/** @typedef {"wide" | "narrow" | "single" | "phone"} Layout */

const PHONE_PX = 600;
const SINGLE_PX = 900;
const NARROW_PX = 1181;
/** Lower windows start with a folded tray. */
const LOW_PX = 720;
/** In lower windows the buttons over the view have no names. */
const TINY_PX = 480;

/** Least width of workspace and stage beside each other, and the largest share of the workspace. */
const LEAST_WORK_PX = 360;
const LEAST_STAGE_PX = 480;
const LARGEST_SHARE = 0.6;
const NARROW_WORK_PX = 416;

/** @param {number} width  CSS pixels of the window @returns {Layout} */
export function layoutOf(width) {
  if (width < PHONE_PX) return "phone";
  if (width < SINGLE_PX) return "single";
  return width < NARROW_PX ? "narrow" : "wide";
}

/** Whether the tray starts folded. @param {number} height  CSS pixels of the window */
export function isLow(height) {
  return height < LOW_PX;
}

/** Whether only icons fit over the view. @param {number} height  CSS pixels of the window */
export function isTiny(height) {
  return height < TINY_PX;
}

/**
 * The range of the workspace's width.
 *
 * @param {number} width  CSS pixels of the window
 * @returns {{ least: number, most: number }}
 */
export function workRange(width) {
  const most = Math.min(Math.round(LARGEST_SHARE * width), width - LEAST_STAGE_PX);
  return { least: Math.min(LEAST_WORK_PX, most), most: Math.max(most, Math.min(LEAST_WORK_PX, most)) };
}

/**
 * The width of the workspace: what the user chose, else that of the tab, inside the range.
 *
 * @param {number} width           CSS pixels of the window
 * @param {number} usual           width that the tab has by itself
 * @param {number | null} chosen   null: never chosen
 */
export function workWidth(width, usual, chosen) {
  const { least, most } = workRange(width);
  const wanted = chosen ?? (layoutOf(width) === "narrow" ? NARROW_WORK_PX : usual);
  return Math.max(least, Math.min(wanted, most));
}
