// Files of other programs that become programs of blocks: Scratch 3 projects, and workspaces that are XML alone. Pure.

import { decoded } from "../browser/text_file.js";
import { readFile, newFile } from "./file.js";
import { generate } from "./generator.js";
import { fileProblemText, problemText, scratchText } from "./messages.js";
import { importSb3 } from "./scratch/import_sb3.js";

/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {import("./state.js").WorkspaceState} WorkspaceState */
/**
 * @typedef {object} Imported
 * @property {string} text      an .aesl file; empty if nothing could be imported
 * @property {string} problem   why nothing could be imported; empty: it could
 * @property {string[]} leftOut   what the file has and the robot cannot do
 * @property {string[]} mistakes  of the blocks, with which the program does not run
 */

/** The first bytes of a ZIP archive. */
const ZIP = "PK";

/**
 * @param {Uint8Array} bytes
 * @param {Translate} t  of blockly.json
 * @returns {Promise<Imported>}
 */
export async function importFile(bytes, t) {
  if (new TextDecoder("latin1").decode(bytes.subarray(0, ZIP.length)) === ZIP) {
    const { state, error, leftOut } = await importSb3(bytes);
    if (error !== null) return refused(scratchText(error, t));
    const texts = leftOut.map((each) => scratchText(each, t));
    return imported(state, texts, t);
  }
  const file = readFile(textOf(bytes));
  const [problem] = file.problems;
  if (problem !== undefined) {
    const { line, column } = problem;
    return refused(t("view.at", { line, column, text: fileProblemText(problem, t) }));
  }
  return file.hasWorkspace ? imported(file.state, [], t) : refused(t("file.noWorkspace"));
}

/** @param {Uint8Array} bytes */
function textOf(bytes) {
  try {
    return decoded(bytes);
  } catch {
    return ""; // no text: refused as such
  }
}

/** @param {WorkspaceState} state @param {string[]} leftOut @param {Translate} t @returns {Imported} */
function imported(state, leftOut, t) {
  const { code, problems } = generate(state);
  const mistakes = problems.filter(({ severity }) => severity === "error").map((each) => problemText(each, t));
  return { text: newFile(state, code), problem: "", leftOut, mistakes };
}

/** @param {string} problem @returns {Imported} */
const refused = (problem) => ({ text: "", problem, leftOut: [], mistakes: [] });
