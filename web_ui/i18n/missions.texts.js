// Evaluated when the page is built (vite.config.js): the page gets the value.

import { readTexts } from "./read_texts.js";

export default readTexts("missions");
