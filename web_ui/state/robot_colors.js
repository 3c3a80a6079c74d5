// A color for each robot, the same in the choice of the robot, at its name and in the 2D view. It is never the only indication.

const COLORS = ["#2f6fd0", "#c23b2e", "#1a7d43", "#a05a00", "#7a3fb5", "#0f7c86", "#b52a7a", "#54606b"];

/** @param {readonly string[]} names  names of all robots @param {string} name */
export function robotColor(names, name) {
  return COLORS[Math.max(0, names.indexOf(name)) % COLORS.length];
}
