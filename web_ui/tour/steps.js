// The steps of the tour: a name, which has words, and what is shown, the first of these that can be seen.

/** @typedef {{ name: string, targets: readonly string[] }} Step */

export const STEPS = /** @type {readonly Step[]} */ ([
  { name: "scene", targets: ["#view", ".editor-slot"] },
  { name: "pad", targets: [".dpad", ".fold"] },
  { name: "hands", targets: ['[data-view="move"]'] },
  { name: "program", targets: ["#editor-switch"] },
  { name: "playgrounds", targets: ["#gallery-open", "#creator-switch"] },
]);
