// Command: prints the Aseba text that is generated for the blocks of a file, or the blocks of a text.

import { readFileSync } from "node:fs";

import { decodedOrMarked } from "../browser/text_file.js";
import texts from "../i18n/blockly.texts.js";
import { LANGUAGES, translator } from "../i18n/index.js";
import { parseArguments, runAsCommand } from "../program_tab/command_line.js";
import { asBlocks } from "./as_blocks.js";
import { difference } from "./compare.js";
import { readFile } from "./file.js";
import { generate } from "./generator.js";
import { importFile } from "./import.js";
import { fileProblemText, problemText, scratchText } from "./messages.js";
import { importSb3 } from "./scratch/import_sb3.js";

/** @typedef {import("../program_tab/command_line.js").Answer} Answer */
/** @typedef {import("./read_workspace.js").FileProblem} FileProblem */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const USAGE = `usage: node web_ui/blockly/cli.js [--compare | --blocks] [--lang CODE] FILE

Print the Aseba text that is generated for the blocks of an .aesl or XML file, or of a Scratch 3 project (.sb3);
'-' is the standard input.

options:
  --compare    instead, print the first line in which the text of an .aesl file differs from the generated one
  --blocks     instead, print an .aesl file with blocks: a block for each statement of an .aesl file or a text of Aseba
  --lang CODE  language of messages: ${Object.keys(LANGUAGES).join(", ")}; default: en

exit codes: 0 printed, 1 the blocks have an error, or no block stands for a line, 2 wrong usage, or a file that cannot be
read
`;
/** The first bytes of a ZIP archive. */
const ZIP = "PK";

/**
 * @param {string[]} command  arguments
 * @param {(path: string) => Uint8Array} [read]
 * @returns {Promise<Answer>}
 */
export async function run(command, read = (path) => readFileSync(path === "-" ? 0 : path)) {
  const options = parseArguments(command, ["--compare", "--blocks"]);
  if (options === null) return { output: "", errors: USAGE, exit: 2 };
  const { path, flags, language } = options;
  if (path === null) return { output: USAGE, errors: "", exit: 0 };
  const t = translator(language, texts);
  try {
    const bytes = read(path);
    if (flags.has("--blocks")) return await blocksOf(path, bytes, t);
    if (isArchive(bytes)) return await project(path, bytes, t);
    return program(path, decodedOrMarked(bytes), flags.has("--compare"), t);
  } catch (error) {
    if (error instanceof Error && "code" in error)
      return { output: "", errors: `${path}: ${error.message}\n`, exit: 2 };
    throw error;
  }
}

/** @param {string} path @param {string} text @param {boolean} compare @param {Translate} t @returns {Answer} */
function program(path, text, compare, t) {
  const file = readFile(text);
  if (file.problems.length > 0) return refused(path, file.problems, t);
  if (!file.hasWorkspace) return { output: "", errors: `${path}: ${t("file.noWorkspace")}\n`, exit: 2 };
  if (!compare) return generated(path, file.state, t);
  const found = difference(file);
  return { output: found === null ? "" : `${found.line}: ${found.stored} | ${found.generated}\n`, errors: "", exit: 0 };
}

/**
 * A file with blocks: those of a project or of a workspace, else a block for each statement of the text.
 *
 * @param {string} path
 * @param {Uint8Array} bytes
 * @param {Translate} t
 * @returns {Promise<Answer>}
 */
async function blocksOf(path, bytes, t) {
  const text = isArchive(bytes) ? "" : decodedOrMarked(bytes);
  const file = text.trimStart().startsWith("<") ? readFile(text) : null;
  if (isArchive(bytes) || file?.kind === "xml") {
    const { text: output, problem, leftOut, mistakes } = await importFile(bytes, t);
    const said = [problem, ...leftOut, ...mistakes].filter((each) => each !== "");
    const exit = problem !== "" ? 2 : mistakes.length > 0 ? 1 : 0;
    return { output, errors: said.map((each) => `${path}: ${each}\n`).join(""), exit };
  }
  if (file !== null && file.code === null) return refused(path, file.problems, t);
  const { text: output, unknown } = asBlocks(file?.code ?? text);
  if (output !== null) return { output, errors: "", exit: 0 };
  return { output: "", errors: `${path}: ${t("file.noBlock", { ...unknown })}\n`, exit: 1 };
}

/** @param {Uint8Array} bytes */
const isArchive = (bytes) => new TextDecoder("latin1").decode(bytes.subarray(0, 2)) === ZIP;

/** @param {string} path @param {readonly FileProblem[]} problems @param {Translate} t @returns {Answer} */
function refused(path, problems, t) {
  const lines = problems.map((problem) => {
    return `${path}:${problem.line}:${problem.column}: ${fileProblemText(problem, t)}\n`;
  });
  return { output: "", errors: lines.join(""), exit: 2 };
}

/** @param {string} path @param {Uint8Array} bytes @param {Translate} t @returns {Promise<Answer>} */
async function project(path, bytes, t) {
  const { state, error, leftOut } = await importSb3(bytes);
  if (error !== null) return { output: "", errors: `${path}: ${scratchText(error, t)}\n`, exit: 2 };
  const answer = generated(path, state, t);
  return { ...answer, errors: leftOut.map((each) => `${path}: ${scratchText(each, t)}\n`).join("") + answer.errors };
}

/** @param {string} path @param {WorkspaceState} state @param {Translate} t @returns {Answer} */
function generated(path, state, t) {
  const { code, problems } = generate(state);
  const errors = problems.map((problem) => `${path}: ${problemText(problem, t)}\n`).join("");
  return { output: code, errors, exit: problems.some(({ severity }) => severity === "error") ? 1 : 0 };
}

await runAsCommand(import.meta.url, run);
