// The steps of the tour: a name, which is a text key, and the targets, of which the first visible one is shown.

/** @typedef {{ name: string, targets: readonly string[] }} Step */

export const STEPS = /** @type {readonly Step[]} */ ([
  { name: "scene", targets: ["#view", ".editor-slot"] },
  { name: "buttons", targets: [".dpad", ".fold"] },
  { name: "move", targets: ['[data-view="move"]'] },
  { name: "program", targets: ["#editor-switch"] },
  { name: "playgrounds", targets: ["#gallery-open", "#creator-switch"] },
]);
