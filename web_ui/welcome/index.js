// The first visit, and what "?" opens: loaded on demand.

import { translator } from "../i18n/index.js";
import welcomeTexts from "../i18n/welcome.texts.js";
import { Starts } from "./starts.js";
import { tourOffer } from "./tour_offer.js";

import "./welcome.css";

/** @typedef {import("../shell/context.js").Context} Context */

export { openKeys } from "./keys_dialog.js";

/** @param {Context} context @param {HTMLElement} slot @param {() => void} close */
export function createStarts(context, slot, close) {
  return new Starts(context, translator(context.language, welcomeTexts), slot, close);
}

/** @param {Context} context */
export function createTourOffer(context) {
  return tourOffer(context, translator(context.language, welcomeTexts));
}
