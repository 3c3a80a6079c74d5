// Programs of blocks to begin with: workspaces in this folder. Their titles are texts of the editor.

import { newFile, readFile } from "../file.js";
import { generate } from "../generator.js";
import SAMPLES from "./samples.texts.js";

/** The file of a sample. @param {string} name */
export function sampleText(name) {
  const { state } = readFile(SAMPLES[name]);
  return newFile(state, generate(state).code);
}
