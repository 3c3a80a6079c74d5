// Prints programs of VPL as lines of JSON, for the compiler: `node print_vpl.js COUNT`. The golden programs with their
// words, then COUNT random ones as every version of VPL generates them; each also as blocks.

import { readFile } from "../../web_ui/blockly/file.js";
import { generate as generateOfBlocks } from "../../web_ui/blockly/generator.js";
import { asBlocks } from "../../web_ui/blockly/as_blocks.js";
import { check } from "../../web_ui/vpl/check.js";
import { generate, generateSource } from "../../web_ui/vpl/generator.js";
import { MODES } from "../../web_ui/vpl/kinds.js";
import { CURRENT, VERSIONS } from "../../web_ui/vpl/versions.js";
import { goldenPrograms, randomNumbers, randomProgram } from "./vpl_programs.js";

/** @param {{ id: string, text: string | undefined, words?: number[] }} line */
function print(line) {
  const { text, unknown } = asBlocks(line.text ?? "");
  const { code, problems } = generateOfBlocks(readFile(text ?? "").state);
  console.log(JSON.stringify({ ...line, blocks: code, problems: unknown === null ? problems : [unknown] }));
}

for (const { id, program, words } of goldenPrograms()) {
  if (words !== undefined) print({ id, words, text: generate(program).source?.text });
}
const random = randomNumbers(1);
let left = Number(process.argv[2]);
while (left > 0) {
  const program = randomProgram(random, MODES[left % 3]);
  if (check(program) !== null) continue;
  left -= 1;
  for (const { id, name, generator } of VERSIONS) {
    if (program.mode === "extended" && generator !== CURRENT) continue;
    print({ id: `random ${left}, ${id} (${name})`, text: generateSource(program, generator).text });
  }
}
