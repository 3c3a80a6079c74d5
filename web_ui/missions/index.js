// Missions, loaded on demand: the list, and the card of the open one.

import { translator } from "../i18n/index.js";
import missionTexts from "../i18n/missions.texts.js";

import "./missions.css";

export { MissionCard } from "./card.js";
export { nextStep } from "./next_step.js";
export { openList } from "./list.js";

/** @param {string} language */
export function missionTranslator(language) {
  return translator(language, missionTexts);
}
