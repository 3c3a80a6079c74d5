// Arrow keys, Home and End in a list of buttons.

/** @param {HTMLElement} list @param {() => readonly HTMLElement[]} rows  those that can be chosen */
export function watchListKeys(list, rows) {
  list.addEventListener("keydown", (event) => {
    const all = rows();
    const at = all.indexOf(/** @type {HTMLElement} */ (document.activeElement));
    const to = { ArrowDown: at + 1, ArrowUp: at - 1 + all.length, Home: 0, End: all.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    all[to % all.length]?.focus();
  });
}
