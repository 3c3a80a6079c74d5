// The steps of the tour: a name, which is a text key, and the targets, of which the first visible one is shown.

/** @typedef {{ name: string, targets: readonly string[] }} Step */

export const STEPS = /** @type {readonly Step[]} */ ([
  { name: "scene", targets: ["#view", "#work"] },
  { name: "buttons", targets: ["#pad", "#tray-unfold"] },
  { name: "move", targets: ['[data-view="move"]'] },
  { name: "program", targets: ["#tab-program", "#bar-program"] },
  { name: "playgrounds", targets: ["#gallery-open", "#tab-playground", "#bar-playground"] },
]);
