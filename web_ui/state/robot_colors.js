// A color for each robot, the same in its tab, at its name and in the 2D view. It is never the only indication.

const COLORS = ["#1259b8", "#b3201a", "#14703c", "#8a4b00", "#7a2fa8", "#0b6f7c", "#a3246b", "#4d5d70"];

/** @param {readonly string[]} names  names of all robots @param {string} name */
export function robotColor(names, name) {
  return COLORS[Math.max(0, names.indexOf(name)) % COLORS.length];
}
