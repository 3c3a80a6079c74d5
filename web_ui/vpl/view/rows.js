// The rows of a program. A row is drawn again only where it has changed.

import { h, setAttribute } from "../../ui/dom.js";
import { spotOf, written } from "./place.js";
import { drawRow, lookOfRow } from "./row.js";

/** @typedef {import("../check.js").Refusal} Refusal */
/** @typedef {import("../program.js").Program} Program */
/** @typedef {import("../program.js").Row} Row */
/**
 * @typedef {object} RowFacts
 * @property {Program} program
 * @property {Refusal | null} refusal
 * @property {number | null} selected
 * @property {import("./place.js").Slot | null} slot   where the next block of the palette goes in that row
 * @property {boolean} isPasting   whether a copied block waits for a place
 */

/** How long a row that has run is lit, and how long it says so. */
const FLASH_MS = 300;
const SAID_MS = 1000;

export class RowList {
  /** @type {{ row: Readonly<Row>, key: string, element: HTMLElement }[]} */ #shown = [];
  #current = written({ row: 0, slot: "event", index: 0 });

  /** @param {{ t: import("../../i18n/index.js").Translate }} options */
  constructor({ t }) {
    this.t = t;
    this.element = h("ol", { class: "vpl-rows", "aria-label": t("rows") });
  }

  /** Make the place the one that Tab reaches. @param {string} place */
  setCurrent(place) {
    for (const old of this.element.querySelectorAll('[tabindex="0"]')) old.setAttribute("tabindex", "-1");
    const found = this.#find(place);
    if (found !== null) {
      this.#current = found.dataset.place ?? place;
      found.setAttribute("tabindex", "0");
    }
    return found;
  }

  /** @param {string} [place] */
  focus(place = this.#current) {
    const found = this.setCurrent(place);
    found?.focus();
    found?.scrollIntoView({ block: "nearest" });
  }

  /** @param {RowFacts} facts */
  render(facts) {
    const focused = this.element.contains(document.activeElement) ? spotOf(document.activeElement) : null;
    const old = this.#shown;
    this.#shown = facts.program.rows.map((row, index) => {
      const key = keyOf(index, facts);
      const known = old[index];
      const isKnown = known !== undefined && known.row === row && known.key === key;
      return isKnown ? known : { row, key, element: drawRow(this.t, row, index, facts) };
    });
    this.#select(facts);
    setAttribute(this.element, "data-pasting", String(facts.isPasting));
    if (old.length === this.#shown.length && this.#shown.every((row, index) => row === old[index])) return;
    this.#replace(old);
    this.setCurrent(focused === null ? this.#current : written(focused));
    if (focused !== null && !this.element.contains(document.activeElement)) this.#find(written(focused))?.focus();
  }

  /** A row has just run. @param {number} index */
  flash(index) {
    const row = this.#shown[index]?.element;
    const said = row?.querySelector(".vpl-ran");
    if (row === undefined || !(said instanceof HTMLElement)) return;
    row.classList.add("ran");
    said.hidden = false;
    const time = String(Number(row.dataset.ran ?? 0) + 1);
    row.dataset.ran = time;
    setTimeout(() => row.dataset.ran === time && row.classList.remove("ran"), FLASH_MS);
    setTimeout(() => row.dataset.ran === time && (said.hidden = true), SAID_MS);
  }

  /**
   * Show what is selected. It changes in place: a press on a button selects its row, and the button must stay until the
   * click.
   *
   * @param {RowFacts} facts
   */
  #select({ refusal, selected, slot }) {
    this.#shown.forEach(({ element }, index) => {
      setAttribute(element, "class", lookOfRow(index, refusal, selected, element));
      for (const button of /** @type {NodeListOf<HTMLElement>} */ (element.querySelectorAll("[data-slot]"))) {
        const isChosen = selected === index && button.dataset.slot === slot;
        setAttribute(button, "aria-pressed", String(isChosen));
      }
    });
  }

  /** Put the rows in the place of those before. @param {{ element: HTMLElement }[]} old */
  #replace(old) {
    const { element } = this;
    old.forEach((each, index) => this.#shown[index] !== each && each.element.remove());
    this.#shown.forEach(({ element: row }, index) => {
      if (element.children[index] !== row) element.insertBefore(row, element.children[index] ?? null);
    });
  }

  /** The element at a place; the nearest one in its row if there is none. @param {string} place */
  #find(place) {
    const { element } = this;
    const exact = element.querySelector(`[data-place="${place}"]`);
    if (exact instanceof HTMLElement) return exact;
    const [row, slot] = place.split(" ");
    const same = [...element.querySelectorAll(`[data-place^="${row} ${slot}"]`)].at(-1);
    const near = same ?? element.querySelector(`[data-place^="${row} event"]`) ?? element.querySelector("[data-place]");
    return /** @type {HTMLElement | null} */ (near);
  }
}

/** What a row shows beside its blocks. @param {number} index @param {RowFacts} facts */
function keyOf(index, { program, refusal }) {
  const isMarked = refusal !== null && (refusal.row === index || refusal.other === index);
  const isLast = index === program.rows.length - 1;
  const mark = isMarked ? [refusal.key, refusal.row, refusal.other] : [];
  return [index, program.mode, isLast, ...mark].join(" ");
}
