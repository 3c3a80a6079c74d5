// Keyboard shortcuts of programs: function keys work everywhere while the tab is shown, the others inside it.

import { plainKey } from "../input/keyboard.js";

/**
 * Returns a function that removes them.
 *
 * @param {HTMLElement} element
 * @param {import("./commands.js").ProgramCommands} commands
 * @returns {() => void}
 */
export function watchKeys(element, commands) {
  const keys = /** @type {Record<string, () => void>} */ ({
    F7: () => void commands.control("step_line"),
    "Shift+F7": () => void commands.control("step"),
    F8: () => void commands.control("reset"),
    F9: () => void commands.goOn(),
    F10: () => void commands.control("pause"),
    "Ctrl+Enter": () => void commands.run(),
    "Ctrl+s": () => commands.save(),
  });
  /** @param {KeyboardEvent} event */
  const press = (event) => {
    if (!element.checkVisibility()) return; // another tab is shown
    const ctrl = event.ctrlKey || event.metaKey ? "Ctrl+" : "";
    const act = keys[`${ctrl}${event.shiftKey ? "Shift+" : ""}${plainKey(event)}`];
    const inside = event.target instanceof Node && element.contains(event.target);
    if (act === undefined || event.altKey || (ctrl !== "" && !inside)) return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) act();
  };
  window.addEventListener("keydown", press, true);
  // Escape closes lists and cards here; unlike elsewhere on the page it does not stop the robots.
  element.addEventListener("keydown", (event) => event.key === "Escape" && event.stopPropagation());
  return () => window.removeEventListener("keydown", press, true);
}
