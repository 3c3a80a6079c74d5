// Reports files that are dropped anywhere on the page, and where.

/** @typedef {import("./opened_file.js").Place} Place */

/** @param {HTMLElement} hint  shown while a file is dragged over the page @param {(file: File, place: Place) => void} open */
export function watchDrops(hint, open) {
  let depth = 0;
  /** @param {number} change */
  const over = (change) => {
    depth = Math.max(0, depth + change);
    hint.hidden = depth === 0;
  };
  window.addEventListener("dragenter", (event) => {
    if (event.dataTransfer?.types.includes("Files")) over(+1);
  });
  window.addEventListener("dragleave", () => over(-1));
  window.addEventListener("dragover", (event) => event.preventDefault());
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    over(-depth);
    const place = { x: event.clientX, y: event.clientY };
    for (const file of event.dataTransfer?.files ?? []) open(file, place);
  });
}
