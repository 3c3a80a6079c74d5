// Blocks as a language of programs (hosts/program_host.js): what is known about it before it is loaded.

/** @typedef {import("../hosts/program_host.js").Language} Language */

/** The element with the blocks, with or without a prefix. */
const ELEMENT = /<(?:[\w-]+:)?ThymioBlockly[\s/>]/;
/** The root of a workspace that is a file of its own. */
const ROOT = /^\uFEFF?\s*(<\?xml[^>]*\?>\s*)?<(\w+:)?xml[\s>/]/;
/** A sample of each family of blocks, in the order of the toolbox. */
const FAMILIES = ["events", "actuators", "leds", "sensors", "logic", "loops", "math", "variables", "subroutines"];
const SCRATCH_FAMILIES = ["motion", "looks", "sound", "events", "control", "sensing", "operators", "variables"];

/** @type {Language} */
export const BLOCKS = {
  id: "blocks",
  icon: "blocks",
  holds: (text) => ELEMENT.test(text),
  samples: [
    { name: "empty", key: "blocks_empty", icon: "file" },
    { name: "avoid", key: "blocks_avoid", icon: "beams" },
    { name: "line", key: "blocks_line", icon: "track" },
    { name: "scratch_start", key: "scratch_start", icon: "blocks" },
    { name: "scratch_avoid", key: "scratch_avoid", icon: "beams" },
    { name: "scratch_line", key: "scratch_line", icon: "track" },
  ],
  more: [
    ...FAMILIES.map((name) => ({ name, key: `blocks_${name}` })),
    ...SCRATCH_FAMILIES.map((name) => ({ name: `scratch_${name}`, key: `scratch_${name}` })),
  ],
  imports: [".sb3", ".xml"],
  load: () => import("./view/index.js"),
  toolboxNames: async () => (await import("./looks.js")).NAMES,
};

/** Whether an XML file is a workspace: a playground can be XML, too. @param {Uint8Array} bytes */
export const looksLikeBlocks = (bytes) => ROOT.test(new TextDecoder().decode(bytes.subarray(0, 2000)));
