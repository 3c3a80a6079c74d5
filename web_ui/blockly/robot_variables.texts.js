// Evaluated when the page is built (vite.config.js): the page gets the value.

import { readTexts } from "../i18n/read_texts.js";

const KIND = "variables.";

/** The names of the variables of a robot, as the help of each one has them. */
export default Object.keys(readTexts("help").en)
  .filter((key) => key.startsWith(KIND))
  .map((key) => key.slice(KIND.length));
