// What the address of the page asks for: `?tour=off&welcome=off` for kiosks and tests, `?scene=off` for pictures of the
// page without the scene.

/**
 * @typedef {object} VisitOptions
 * @property {boolean | null} tour      null: as the browser remembers
 * @property {boolean | null} welcome   null: as the browser remembers
 * @property {boolean} scene            whether the scene is drawn
 */

/** @param {string} search  query part of the address @returns {VisitOptions} */
export function visitOptions(search) {
  const parameters = new URLSearchParams(search);
  /** @param {string} name */
  const choice = (name) => {
    const value = parameters.get(name);
    return value === "on" || value === "off" ? value === "on" : null;
  };
  return { tour: choice("tour"), welcome: choice("welcome"), scene: choice("scene") ?? true };
}
