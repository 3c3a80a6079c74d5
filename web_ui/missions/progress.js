// What this browser keeps of the missions: stars, and the pupil's program of each mission and language.

import { trySetItem } from "../browser/local_storage.js";

const STARS_KEY = "missions.stars";
/** @param {string} mission @param {string} language */
const programKey = (mission, language) => `missions.program.${mission}.${language}`;
/** @param {string} mission */
const languageKey = (mission) => `missions.language.${mission}`;

export class Progress {
  /** @param {import("../browser/local_storage.js").KeyValueStore} storage */
  constructor(storage) {
    this.storage = storage;
  }

  /** The most stars that a try got; null: the mission is not passed yet. @param {string} mission @returns {number | null} */
  starsOf(mission) {
    const found = this.#stars()[mission];
    return Number.isInteger(found) ? found : null;
  }

  /** Keep the stars of a try that passed, if they are the most. @param {string} mission @param {number} stars */
  note(mission, stars) {
    if (stars <= (this.starsOf(mission) ?? 0)) return;
    trySetItem(this.storage, STARS_KEY, JSON.stringify({ ...this.#stars(), [mission]: stars }));
  }

  /** The pupil's program; null: none yet. @param {string} mission @param {string} language */
  program(mission, language) {
    return this.storage.getItem(programKey(mission, language));
  }

  /** @param {string} mission @param {string} language @param {string} text */
  keepProgram(mission, language, text) {
    trySetItem(this.storage, programKey(mission, language), text);
  }

  /** The language that the pupil chose last; null: none. @param {string} mission */
  language(mission) {
    return this.storage.getItem(languageKey(mission));
  }

  /** @param {string} mission @param {string} language */
  keepLanguage(mission, language) {
    trySetItem(this.storage, languageKey(mission), language);
  }

  /** @returns {Record<string, any>} */
  #stars() {
    try {
      const found = JSON.parse(this.storage.getItem(STARS_KEY) ?? "{}");
      return typeof found === "object" && found !== null ? found : {};
    } catch {
      return {};
    }
  }
}
