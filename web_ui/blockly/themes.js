// Colors of blocks and categories in both looks: of the hues of the existing Blockly page, and like those that pupils
// know from Scratch. All are dark enough for white text (contrast of at least 4.5).

/** @typedef {import("./toolbox.js").Look} Look */

/**
 * Style → color of the existing page's hues: 10, 60, 160, 230, 210, 210, 120, 230, 330, 290.
 *
 * @type {Record<string, string>}
 */
const COLORS = {
  event: "#a66153",
  actuator: "#78783c",
  led: "#407f6a",
  sensor: "#5361a6",
  sensor_check: "#4f779e",
  logic: "#4f779e",
  loop: "#418241",
  math: "#5361a6",
  variable: "#a6537c",
  procedure: "#9853a6",
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

/** Everything but blocks has the colors of the page, which follow its theme by themselves. */
const COMPONENTS = {
  workspaceBackgroundColour: "var(--card)",
  toolboxBackgroundColour: "var(--sunk)",
  toolboxForegroundColour: "var(--ink)",
  flyoutBackgroundColour: "var(--sunk)",
  flyoutForegroundColour: "var(--ink)",
  flyoutOpacity: 1,
  scrollbarColour: "var(--edge)",
  insertionMarkerColour: "var(--you)",
  insertionMarkerOpacity: 0.4,
  cursorColour: "var(--you)",
  selectedGlowColour: "var(--you)",
};

/**
 * What `Blockly.Theme.defineTheme` gets.
 *
 * @param {Look} look
 */
export function theme(look) {
  const isScratch = look === "scratch";
  const colors = Object.entries({ ...COLORS, ...(isScratch ? AS_SCRATCH : {}) });
  return {
    name: `thymio-${look}`,
    base: isScratch ? "zelos" : "classic",
    blockStyles: Object.fromEntries(
      colors.map(([name, colourPrimary]) => [
        `${name}_blocks`,
        {
          colourPrimary,
          colourSecondary: darker(colourPrimary, 0.88),
          colourTertiary: darker(colourPrimary, 0.72),
          ...(isScratch && HATS.includes(name) ? { hat: "cap" } : {}),
        },
      ]),
    ),
    categoryStyles: Object.fromEntries(
      colors.map(([name, color]) => [`${name}_category`, { colour: color }]), // codespell:ignore colour
    ),
    componentStyles: COMPONENTS,
    startHats: false,
  };
}

/** @param {string} color @param {number} factor */
function darker(color, factor) {
  const parts = [1, 3, 5].map((at) => Math.round(parseInt(color.slice(at, at + 2), 16) * factor));
  return `#${parts.map((part) => part.toString(16).padStart(2, "0")).join("")}`;
}

/** Renderer of a look. @type {Record<Look, string>} */
export const RENDERERS = { blockly: "geras", scratch: "zelos" };
