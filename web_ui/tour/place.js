// Positions the card of the tour: beside its target, inside the window. Pure.

/** @typedef {{ left: number, top: number, width: number, height: number }} Box  CSS pixels of the window */
/** @typedef {{ width: number, height: number }} Size */

const GAP = 14;
const MARGIN = 8;

/**
 * The upper left corner of the card.
 *
 * @param {Size} card
 * @param {Box | null} target  null: no visible target
 * @param {Size} window
 * @returns {{ left: number, top: number }}
 */
export function placed(card, target, window) {
  const middle = { left: (window.width - card.width) / 2, top: (window.height - card.height) / 2 };
  if (target === null) return inside(middle, card, window);
  const alongX = target.left + (target.width - card.width) / 2;
  const alongY = target.top + (target.height - card.height) / 2;
  const beside = [
    { left: alongX, top: target.top + target.height + GAP },
    { left: alongX, top: target.top - card.height - GAP },
    { left: target.left + target.width + GAP, top: alongY },
    { left: target.left - card.width - GAP, top: alongY },
  ].map((corner) => inside(corner, card, window));
  const free = beside.find((corner) => !overlap({ ...corner, ...card }, target));
  // A large target has room for the card inside: at the top, where it covers least of the view.
  return free ?? inside({ left: alongX, top: target.top + 2 * GAP }, card, window);
}

/** @param {{ left: number, top: number }} corner @param {Size} card @param {Size} window */
function inside({ left, top }, card, window) {
  return {
    left: Math.max(MARGIN, Math.min(left, window.width - card.width - MARGIN)),
    top: Math.max(MARGIN, Math.min(top, window.height - card.height - MARGIN)),
  };
}

/** @param {Box} one @param {Box} other */
function overlap(one, other) {
  return (
    one.left < other.left + other.width &&
    other.left < one.left + one.width &&
    one.top < other.top + other.height &&
    other.top < one.top + one.height
  );
}
