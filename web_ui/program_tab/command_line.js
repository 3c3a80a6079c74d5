// What the commands share that print the text of a file (docs/vpl.md, docs/blockly.md). Runs in Node only.

import { realpathSync } from "node:fs";
import { pathToFileURL } from "node:url";

import { LANGUAGES } from "../i18n/index.js";

/** @typedef {{ output: string, errors: string, exit: 0 | 1 | 2 }} Answer */
/** @typedef {{ path: string | null, flags: Set<string>, language: string }} Options   no path: the user asks for help */

/**
 * The options of a command; null if they are wrong.
 *
 * @param {string[]} command
 * @param {readonly string[]} known   flags of this command, such as "--compare"; one of them at most is given
 * @returns {Options | null}
 */
export function parseArguments(command, known) {
  const rest = [...command];
  const options = { flags: new Set(), language: "en" };
  /** @type {string[]} */ const paths = [];
  while (rest.length > 0) {
    const word = /** @type {string} */ (rest.shift());
    if (word === "-h" || word === "--help") return { path: null, ...options };
    if (known.includes(word)) options.flags.add(word);
    else if (word === "--lang") options.language = rest.shift() ?? "";
    else if (word.startsWith("-") && word !== "-") return null;
    else paths.push(word);
  }
  const isRight = paths.length === 1 && options.flags.size <= 1 && options.language in LANGUAGES;
  return isRight ? { path: paths[0], ...options } : null;
}

/**
 * Run a command if Node was started with its module.
 *
 * @param {string} module   `import.meta.url`
 * @param {(command: string[]) => Answer | Promise<Answer>} run
 */
export async function runAsCommand(module, run) {
  const [, started, ...command] = process.argv;
  if (started === undefined || module !== pathToFileURL(realpathSync(started)).href) return;
  const { output, errors, exit } = await run(command);
  process.stdout.write(output);
  process.stderr.write(errors);
  process.exitCode = exit;
}
