// The keyboard's focus is never lost: what removes the focused element says where it goes.

/** Where it goes by default: into the open dialog, else to the view, else to the workspace. @returns {HTMLElement | null} */
function mainPlace() {
  const dialog = /** @type {HTMLElement | null} */ (document.querySelector("dialog:modal button"));
  const view = /** @type {HTMLElement | null} */ (document.querySelector("#view"));
  return dialog ?? (view?.checkVisibility() ? view : document.querySelector("#work"));
}

/**
 * Change a part of the page. If the element that had the focus is gone afterwards, another one gets it.
 *
 * @param {Element} part
 * @param {() => void} change
 * @param {() => Element | null | undefined} [next]   the other one; without one, the main place of the page
 */
export function keepFocus(part, change, next = () => null) {
  const { activeElement } = document;
  const hadFocus = part.contains(activeElement);
  change();
  if (!hadFocus || (activeElement?.isConnected && document.activeElement === activeElement)) return;
  if (document.activeElement !== null && document.activeElement !== document.body) return; // moved on purpose
  const place = /** @type {HTMLElement | null} */ (next() ?? mainPlace());
  place?.focus({ preventScroll: true });
}
