// The steps of the tour: a name, which is a text key, and the targets, of which the first visible one is shown.

/** @typedef {{ name: string, targets: readonly string[] }} Step */

export const STEPS = /** @type {readonly Step[]} */ ([
  { name: "scene", targets: ["#view", "#work"] },
  { name: "hands", targets: ["#tray", "#tray-unfold", "#bar-drive"] },
  { name: "robot", targets: ["#tab-robot", "#bar-robot"] },
  { name: "program", targets: ["#tab-program", "#bar-program"] },
  { name: "playground", targets: ["#tab-playground", "#bar-playground"] },
]);
