// Which built-in behaviors are offered as examples, and in which order. Pure.

/** Those that move by themselves at once, the simplest first; the others follow. */
const FIRST = ["line_follower", "explorer", "friendly"];
/** No examples: the menu, and the program that only waits. */
const OTHERS = ["menu", "welcome"];

/** @param {readonly { name: string }[]} behaviors @returns {string[]} names */
export function offeredExamples(behaviors) {
  const names = behaviors.map(({ name }) => name).filter((name) => !OTHERS.includes(name));
  return [...FIRST.filter((name) => names.includes(name)), ...names.filter((name) => !FIRST.includes(name))];
}
