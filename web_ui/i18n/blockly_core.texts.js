// Evaluated when the page is built (vite.config.js): the page gets the value. Texts that Blockly lacks in a language.

import { readTexts } from "./read_texts.js";

export default readTexts("blockly_core");
