// Which values are listed, and in what order. Pure.

/** How many values of the robot are listed at first, those that the program uses among them. */
const FEW = 8;
const NAME = /[\p{L}_][\p{L}\p{N}_.]*/gu;

/** @typedef {{ watched: string[], own: string[], robot: string[] }} Listed   names by heading */

/** The words of a program that may be names. @param {string} code @returns {ReadonlySet<string>} */
export function namesIn(code) {
  return new Set(code.replace(/#\*[^]*?\*#|#.*/g, "").match(NAME) ?? []);
}

/**
 * @param {object} options
 * @param {readonly string[]} options.names              of all values, in order of address
 * @param {readonly import("../state.js").TargetVariable[]} options.robot   of the robot, the most useful first
 * @param {ReadonlySet<string>} options.watched
 * @param {ReadonlySet<string>} options.used             names that the program uses
 * @param {string} options.wanted                        part of a name; empty: all
 * @param {boolean} options.all                          whether all are listed
 * @param {boolean} options.hidden                       whether hidden ones are listed too
 * @returns {Listed & { count: number }}   count: how many there are without the hidden ones
 */
export function listValues({ names, robot, watched, used, wanted, all, hidden }) {
  const there = new Set(names);
  const known = new Map(robot.map((each) => [each.name, each]));
  /** @param {string} name */
  const isSecret = (name) => known.get(name)?.hidden ?? /(^|\.)_/.test(name);
  const word = wanted.trim().toLowerCase();
  /** @param {string} name */
  const fits = (name) => name.toLowerCase().includes(word) && (hidden || !isSecret(name));
  const ofRobot = robot.map(({ name }) => name).filter((name) => there.has(name));
  const shown = ofRobot.filter((name) => fits(name) && !watched.has(name));
  const few = [...shown.filter((name) => used.has(name)), ...shown.filter((name) => !used.has(name))].slice(0, FEW);
  return {
    watched: names.filter((name) => watched.has(name) && fits(name)),
    own: names.filter((name) => !known.has(name) && !watched.has(name) && fits(name)),
    robot: all ? shown : few,
    count: names.filter((name) => !isSecret(name)).length,
  };
}
