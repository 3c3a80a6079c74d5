// The letters of the hands while the view has the focus.

/** @typedef {"tap" | "clap" | "lift" | "hand" | "tilt" | "pen" | "remote" | "room"} HandName */

export const HAND_KEYS = /** @type {Readonly<Record<HandName, string>>} */ ({
  tap: "K",
  clap: "C",
  lift: "L",
  hand: "H",
  tilt: "I",
  pen: "P",
  remote: "R",
  room: "S",
});

/** The hand of a key, if there is one. @param {string} key  in lower case @returns {HandName | undefined} */
export function handOfKey(key) {
  const names = /** @type {HandName[]} */ (Object.keys(HAND_KEYS));
  return names.find((name) => HAND_KEYS[name].toLowerCase() === key);
}
