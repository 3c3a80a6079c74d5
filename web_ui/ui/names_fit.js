// How the names of a row of buttons are shown: as much of them as fits.

/** From the most to the least: all beside the icons; only those without `data-extra`; below the icons; the chosen one. */
export const NAMES = /** @type {const} */ (["beside", "most", "below", "few"]);

/**
 * The first of the ways that fits, else the last. Pure.
 *
 * @template {string} Names
 * @param {readonly Names[]} ways
 * @param {(names: Names) => boolean} fits
 */
export function firstThatFits(ways, fits) {
  return ways.find(fits) ?? ways[ways.length - 1];
}

/**
 * Show names, now and whenever the element changes its width, in the first way that fits: its `data-names`.
 *
 * @param {HTMLElement} element
 * @param {() => readonly string[]} ways
 * @param {() => boolean} fits   whether what is shown now has room
 * @returns {() => void}   call when names have changed
 */
export function fitNames(element, ways, fits) {
  const show = (/** @type {string} */ names) => void (element.dataset.names = names);
  const fit = () =>
    show(
      firstThatFits(ways(), (names) => {
        show(names);
        return fits();
      }),
    );
  let width = -1;
  new ResizeObserver(() => {
    if (element.clientWidth === width) return;
    width = element.clientWidth;
    fit();
  }).observe(element);
  return fit;
}
