// Colors of blocks and categories in both looks. Hues are those of the existing Blockly page, colors those that pupils
// know from Scratch, dark enough for white text.

/** @typedef {import("./toolbox.js").Look} Look */

/** Style → hue of Blockly. @type {Record<string, number>} */
const HUES = {
  event: 10,
  actuator: 60,
  led: 160,
  sensor: 230,
  sensor_check: 210,
  logic: 210,
  loop: 120,
  math: 230,
  variable: 330,
  procedure: 290,
};

/** Style → color. @type {Record<string, string>} */
const COLORS = {
  motion: "#3373cc",
  looks: "#774dcb",
  sound: "#9b3d9b",
  scratch_event: "#996600",
  control: "#a35c00",
  sensing: "#2e7d9c",
  operator: "#2f7a31",
};

/** What logic, loops, math and variables are in the Scratch look. @type {Record<string, string>} */
const AS_SCRATCH = {
  logic: COLORS.control,
  loop: COLORS.control,
  math: COLORS.operator,
  variable: "#b35900",
  procedure: "#c2334d",
};

/** Blocks without anything above them, whose upper edge is rounded in the Scratch look. */
const HATS = ["event", "scratch_event", "procedure"];

/**
 * What `Blockly.Theme.defineTheme` gets.
 *
 * @param {Look} look
 */
export function theme(look) {
  const isScratch = look === "scratch";
  const colors = { ...HUES, ...COLORS, ...(isScratch ? AS_SCRATCH : {}) };
  const entries = Object.entries(colors).map(([name, color]) => /** @type {const} */ ([name, String(color)]));
  return {
    name: `thymio-${look}`,
    base: isScratch ? "zelos" : "classic",
    blockStyles: Object.fromEntries(
      entries.map(([name, colourPrimary]) => [
        `${name}_blocks`,
        { colourPrimary, ...(isScratch && HATS.includes(name) ? { hat: "cap" } : {}) },
      ]),
    ),
    categoryStyles: Object.fromEntries(entries.map(([name, colour]) => [`${name}_category`, { colour }])),
    startHats: false,
  };
}

/** Renderer of a look. @type {Record<Look, string>} */
export const RENDERERS = { blockly: "geras", scratch: "zelos" };
