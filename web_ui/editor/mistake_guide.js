// Leads the user to mistakes: marks in the text, the card below the line, the words at the foot.

import { mistakesIn } from "../input/check_service.js";
import { marks } from "./marks.js";
import { showCard } from "./mistake_card.js";
import { countMistakes, explainMistake, sentence } from "./mistakes.js";

/** While the user types, a card waits for a pause: a word that is not finished is no mistake yet. */
const PAUSE_MS = 900;

/** @typedef {import("../input/check_service.js").Remark} Remark */
/** @typedef {import("./mistake_card.js").Placed} Placed */

export class MistakeGuide {
  /** @type {Placed | null} the card for the checked text */ #card = null;
  /** @type {Placed | null} the card for a fault of the running program */ #faultCard = null;
  #isShown = false;
  /** @type {{ text: string, repair: import("./marks.js").Repair } | null} */ #correction = null;
  /** @type {Remark | null} the first error, else the first warning */ #first = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;
  #announced = "";

  /**
   * @param {object} options
   * @param {import("../i18n/index.js").Translate} options.t
   * @param {() => import("./text_field.js").TextField} options.text
   * @param {ReturnType<typeof import("./foot.js").footOf>} options.foot
   * @param {(text: string) => void} options.announce
   */
  constructor({ t, text, foot, announce }) {
    this.t = t;
    this.text = text;
    this.foot = foot;
    this.announce = announce;
  }

  /** Another text is shown. */
  forget() {
    this.#card = this.#faultCard = this.#correction = this.#first = null;
    this.#announced = "";
    this.#hide();
  }

  /** The text changes: a card that waits waits on. */
  typed() {
    clearTimeout(this.#timer);
  }

  /** @param {import("./program_checker.js").Finding} finding */
  found({ source, verdict, isTyping }) {
    const { t } = this;
    if (verdict === null) return this.foot.report({ text: t("check.unknown"), kind: "" });
    const found = marks(source, verdict);
    this.text().mark(found);
    this.#first = [...verdict.errors, ...verdict.warnings][0] ?? null;
    const errors = found.filter(({ severity }) => severity === "error");
    const shown = errors.find(({ hint }) => hint !== undefined) ?? errors[0];
    const { repair = null } = shown ?? {};
    this.#correction = repair && { text: source, repair };
    const isMistake = mistakesIn(verdict).length > 0;
    const isExplained = isMistake && shown !== undefined;
    this.#card = isExplained ? { from: shown.from, mistake: explainMistake(t, source, shown) } : null;
    if (isMistake || this.#faultCard === null) this.#showLater(isTyping && !this.#isShown);
    this.#reportVerdict(verdict);
  }

  /** @param {import("../input/check_service.js").Verdict} verdict */
  #reportVerdict(verdict) {
    const { t } = this;
    const first = this.#first;
    if (first === null) {
      this.#announced = "";
      return this.foot.report({ text: t("mistakes.none"), kind: "good" });
    }
    const { line, message } = first;
    const mistakes = mistakesIn(verdict);
    if (mistakes.length > 0) this.foot.report({ text: countMistakes(t, mistakes), kind: "error" });
    else {
      const text = line === null ? sentence(message) : t("check.error", { line, message });
      this.foot.report({ text, kind: verdict.errors.length > 0 ? "error" : "warning" });
    }
    const mistake = this.#card?.mistake;
    if (mistake === undefined) return;
    const words = `${t("mistakes.here", { line: line ?? 1 })}: ${mistake.title} ${mistake.text}`;
    if (words !== this.#announced) this.announce(words);
    this.#announced = words;
  }

  /**
   * The program failed while it ran.
   *
   * @param {number} line   of the text, from 1; 0: it did not
   * @param {string} message
   */
  failed(line, message) {
    const { doc } = this.text().view.state;
    if (line < 1 || line > doc.lines) {
      if (this.#faultCard === null) return;
      this.#faultCard = null;
    } else {
      const mistake = { title: this.t("mistake.fault"), text: sentence(message), more: "", change: null, button: "" };
      this.#faultCard = { from: doc.line(line).from, mistake };
    }
    this.#showLater(false);
  }

  /** Put the cursor at the first mistake, and explain it. */
  go() {
    const { view } = this.text();
    const { doc } = view.state;
    const { line = null, column = null } = this.#first ?? {};
    this.#show();
    if (line === null || line > doc.lines) return;
    const at = doc.line(line);
    const anchor = Math.min(at.from + (column ?? 1) - 1, at.to);
    view.dispatch({ selection: { anchor }, scrollIntoView: true });
    view.focus();
  }

  /** Apply the proposed repair; the text is checked again. */
  correct() {
    if (this.#correction === null || !this.text().repair(this.#correction.text, this.#correction.repair)) return;
    this.#correction = this.#card = null;
    this.#hide();
    this.announce(this.t("hint.done"));
  }

  destroy() {
    clearTimeout(this.#timer);
  }

  /** @param {boolean} isLater */
  #showLater(isLater) {
    clearTimeout(this.#timer);
    if (isLater && this.#card !== null) this.#timer = setTimeout(() => this.#show(), PAUSE_MS);
    else this.#show();
  }

  #show() {
    clearTimeout(this.#timer);
    const card = this.#card ?? this.#faultCard;
    if (card === null) return this.#hide();
    this.#isShown = true;
    showCard(this.text().view, card);
  }

  #hide() {
    clearTimeout(this.#timer);
    if (!this.#isShown) return;
    this.#isShown = false;
    showCard(this.text().view, null);
  }
}
