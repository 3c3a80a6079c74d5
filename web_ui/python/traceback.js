// The error of a Python program in its output: the line of the program and what Python says. Pure.

/** @typedef {{ line: number, message: string }} PythonError   line: from 1 */

const PLACE = /^\s+File "([^"]+)", line (\d+)/;
/** The last line of an error: the name of an exception, alone or with a message. */
const MESSAGE = /^([A-Za-z_][\w.]*)(?:: (.*))?$/;
const NAMED = /(?:Error|Exception|Warning|Exit|Interrupt|Iteration)$/;

/**
 * The last error that a program has printed, with the innermost line of its file; null: there is none.
 *
 * @param {string} output
 * @param {string} file   name of the program's file
 * @returns {PythonError | null}
 */
export function errorIn(output, file) {
  /** @type {PythonError | null} */ let found = null;
  let line = 0;
  for (const text of output.split("\n")) {
    const place = PLACE.exec(text);
    if (place !== null) {
      if (place[1] === file) line = Number(place[2]);
      continue;
    }
    if (line === 0 || text === "" || /^\s/.test(text) || text.startsWith("Traceback ")) continue;
    const message = MESSAGE.exec(text);
    if (message !== null && (message[2] !== undefined || NAMED.test(message[1]))) found = { line, message: text };
    line = 0;
  }
  return found;
}
