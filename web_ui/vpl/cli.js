// Command: prints the Aseba text that is generated for the VPL program of a file (docs/vpl.md).

import { readFileSync } from "node:fs";

import { decodedOrMarked } from "../browser/text_file.js";
import { LANGUAGES, translator } from "../i18n/index.js";
import texts from "../i18n/vpl.texts.js";
import { parseArguments, runAsCommand } from "../program_tab/command_line.js";
import { warningOf } from "./check.js";
import { compareText } from "./compare.js";
import { VplError } from "./errors.js";
import { readVpl } from "./file.js";
import { generate } from "./generator.js";

/** @typedef {import("./program.js").Finding} Finding */
/** @typedef {import("../program_tab/command_line.js").Answer} Answer */

const USAGE = `usage: node web_ui/vpl/cli.js [--compare] [--lang CODE] FILE

Print the Aseba text that is generated for the VPL program of an .aesl file; '-' is the standard input.

options:
  --compare    instead, print where the text of the file comes from, and what changes when it is generated anew
  --lang CODE  language of messages: ${Object.keys(LANGUAGES).join(", ")}; default: en

exit codes: 0 printed, 1 the program has an error, 2 wrong usage, or a file that cannot be read as VPL
`;

/**
 * @param {string[]} command  arguments
 * @param {(path: string) => string} [read]
 * @returns {Answer}
 */
export function run(command, read = readText) {
  const options = parseArguments(command, ["--compare"]);
  if (options === null) return { output: "", errors: USAGE, exit: 2 };
  const { path, flags, language } = options;
  if (path === null) return { output: USAGE, errors: "", exit: 0 };
  const t = translator(language, texts);
  /** @param {Finding} finding */
  const line = ({ key, values }) => `${path}: ${t(key, values)}\n`;
  try {
    const file = readVpl(read(path));
    const warnings = file.warnings.map(line).join("");
    const { source, refusal } = generate(file.program);
    if (flags.has("--compare")) {
      const { message, changes } = compareText(file);
      const about = [message, ...(refusal === null ? [] : [refusal]), ...changes];
      return { output: about.map(line).join(""), errors: warnings, exit: 0 };
    }
    if (source === null) return { output: "", errors: warnings + line(refusal), exit: 1 };
    const open = file.program.rows.map((row, index) => ({ key: warningOf(row), values: { row: index + 1 } }));
    const said = open.map(({ key, values }) => (key === null ? "" : line({ key, values })));
    return { output: source.text, errors: warnings + said.join(""), exit: 0 };
  } catch (error) {
    if (error instanceof VplError) return { output: "", errors: line(error), exit: 2 };
    if (error instanceof Error && "code" in error)
      return { output: "", errors: `${path}: ${error.message}\n`, exit: 2 };
    throw error;
  }
}

/** @param {string} path */
function readText(path) {
  return decodedOrMarked(readFileSync(path === "-" ? 0 : path));
}

await runAsCommand(import.meta.url, run);
