// The rows of a program. A row is drawn again only where it has changed.

import { isEmptyRow } from "../program.js";
import { palette } from "../mode.js";
import { h, setAttribute } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { warningOf } from "../check.js";
import { picture } from "./picture.js";
import { spotOf, written } from "./place.js";
import { sentence } from "./sentences.js";

/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../check.js").Refusal} Refusal */
/** @typedef {import("../program.js").Program} Program */
/** @typedef {import("../program.js").Row} Row */
/** @typedef {import("./place.js").Spot} Spot */
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

/** @param {{ t: import("../../i18n/index.js").Translate }} options */
export function rowList({ t }) {
  const element = h("ol", { class: "vpl-rows", "aria-label": t("rows") });
  /** @type {{ row: Readonly<Row>, key: string, element: HTMLElement }[]} */ let shown = [];
  let current = written({ row: 0, slot: "event", index: 0 });

  /** @param {Block} block @param {Spot} spot */
  const blockButton = (block, spot) => {
    const words = sentence(block, t);
    const button = h("button", {
      type: "button", class: "vpl-block", "data-place": written(spot), "data-block": block.name, "data-drag": "",
      "aria-label": words, title: words, "aria-haspopup": "dialog", tabindex: "-1",
    }); // prettier-ignore
    button.innerHTML = picture(block);
    return button;
  };

  /** @param {Spot & { slot: import("./place.js").Slot }} spot @param {boolean} isMissing */
  const slotButton = (spot, isMissing) => {
    const words = t(`slot.${spot.slot}`, { row: spot.row + 1 });
    const look = `vpl-slot ${spot.slot}${isMissing ? " missing" : ""}`;
    const state = { "data-slot": spot.slot, "aria-label": words, title: words, "aria-pressed": "false", tabindex: "-1" };
    return h("button", { type: "button", class: look, "data-place": written(spot), ...state }, icon("add"));
  };

  /** @param {Readonly<Row>} row @param {number} index @param {RowFacts} facts */
  const draw = (row, index, { program, refusal, selected }) => {
    const isHere = refusal !== null && refusal.row === index;
    /** @param {Block | null} block @param {import("./place.js").Slot} name @param {number} at */
    const at = (block, name, at) => {
      const spot = { row: index, slot: name, index: at };
      if (block !== null) return blockButton(block, spot);
      const isEmpty = name === "event" || row.actions.length === 0;
      return slotButton(spot, isHere && refusal.slot === name && !refusal.hint && isEmpty);
    };
    const isLast = index === program.rows.length - 1 && isEmptyRow(row);
    const conditions = row.conditions.map((block, each) => at(block, "conditions", each));
    const actions = row.actions.map((block, each) => at(block, "actions", each));
    /** The place for one more block. @param {"conditions" | "actions"} name */
    const more = (name) => at(null, name, row[name].length);
    const isFull = row.actions.length >= palette("action", program.mode).length;
    const number = h(
      "button",
      {
        type: "button", class: "vpl-number", "data-place": written({ row: index, slot: "row", index: 0 }), tabindex: "-1",
        "data-drag": isLast ? null : "", "aria-label": t("row.menu", { row: index + 1 }), "aria-haspopup": "menu",
      },
      String(index + 1),
    ); // prettier-ignore
    const bin = h(
      "button",
      {
        type: "button", class: "btn icon vpl-remove", "data-place": written({ row: index, slot: "remove", index: 0 }),
        tabindex: "-1", "aria-label": t("row.remove", { row: index + 1 }), title: t("row.remove", { row: index + 1 }),
      },
      icon("remove", { small: true }),
    ); // prettier-ignore
    return h(
      "li",
      { class: lookOf(index, refusal, selected), "data-row": index },
      number,
      at(row.event, "event", 0),
      ...(row.state === null ? [] : [at(row.state, "state", 0)]),
      ...(program.mode === "extended" ? [h("span", { class: "vpl-conditions" }, ...conditions, more("conditions"))] : []),
      h("span", { class: "vpl-arrow", "aria-hidden": "true" }, icon("right", { small: true })),
      h("span", { class: "vpl-actions" }, ...actions, ...(isFull ? [] : [more("actions")]), ...whyOf(row, index, refusal)),
      ...(isLast ? [] : [bin]),
      h("span", { class: "chip vpl-ran", hidden: true }, icon("check", { small: true }), t("row.ran")),
    ); // prettier-ignore
  };

  /** What is wrong in a row, beside the place where it is.
   * @param {Readonly<import("../program.js").Row>} row @param {number} index @param {Refusal | null} refusal */
  const whyOf = (row, index, refusal) => {
    if (refusal?.row === index) {
      const look = refusal.hint ? "vpl-why hint" : "vpl-why";
      const words = t(refusal.key, refusal.values);
      return [h("span", { class: look }, icon(refusal.hint ? "idea" : "warning", { small: true }), h("span", {}, words))];
    }
    if (refusal === null || refusal.other !== index) {
      const key = warningOf(row);
      if (key === null) return [];
      const text = t(key, { row: index + 1 });
      return [h("span", { class: "vpl-why hint" }, icon("warning", { small: true }), h("span", {}, text))];
    }
    const words = t("row.twin", { row: refusal.row + 1 });
    return [h("span", { class: "vpl-why twin" }, icon("warning", { small: true }), h("span", {}, words))];
  };

  /** What a row shows beside its blocks. @param {number} index @param {RowFacts} facts */
  const keyOf = (index, { program, refusal }) => {
    const isMarked = refusal !== null && (refusal.row === index || refusal.other === index);
    const isLast = index === program.rows.length - 1;
    const mark = isMarked ? [refusal.key, refusal.row, refusal.other] : [];
    return [index, program.mode, isLast, ...mark].join(" ");
  };

  /** The element at a place; the nearest one in its row if there is none. @param {string} place */
  const find = (place) => {
    const exact = element.querySelector(`[data-place="${place}"]`);
    if (exact instanceof HTMLElement) return exact;
    const [row, slot] = place.split(" ");
    const same = [...element.querySelectorAll(`[data-place^="${row} ${slot}"]`)].at(-1);
    const near = same ?? element.querySelector(`[data-place^="${row} event"]`) ?? element.querySelector("[data-place]");
    return /** @type {HTMLElement | null} */ (near);
  };

  /** Make the place the one that Tab reaches. @param {string} place */
  const setCurrent = (place) => {
    for (const old of element.querySelectorAll('[tabindex="0"]')) old.setAttribute("tabindex", "-1");
    const found = find(place);
    if (found !== null) {
      current = found.dataset.place ?? place;
      found.setAttribute("tabindex", "0");
    }
    return found;
  };

  return {
    element,
    /** The place that Tab reaches. */
    get current() {
      return current;
    },
    setCurrent,
    /** @param {string} [place] */
    focus(place = current) {
      const found = setCurrent(place);
      found?.focus();
      found?.scrollIntoView({ block: "nearest" });
    },
    /** @param {RowFacts} facts */
    render(facts) {
      const { program, refusal, selected } = facts;
      const focused = element.contains(document.activeElement) ? spotOf(document.activeElement) : null;
      const old = shown;
      let isSame = old.length === program.rows.length;
      shown = program.rows.map((row, index) => {
        const key = keyOf(index, facts);
        const known = old[index];
        if (known !== undefined && known.row === row && known.key === key) return known;
        isSame = false;
        return { row, key, element: draw(row, index, facts) };
      });
      // What is selected changes in place: a press on a button selects its row, and the button must stay until the click.
      shown.forEach(({ element: each }, index) => {
        setAttribute(each, "class", lookOf(index, refusal, selected, each));
        for (const button of /** @type {NodeListOf<HTMLElement>} */ (each.querySelectorAll("[data-slot]"))) {
          const isChosen = selected === index && button.dataset.slot === facts.slot;
          setAttribute(button, "aria-pressed", String(isChosen));
        }
      });
      setAttribute(element, "data-pasting", String(facts.isPasting));
      if (isSame) return;
      old.forEach((each, index) => shown[index] !== each && each.element.remove());
      shown.forEach(({ element: each }, index) => {
        if (element.children[index] !== each) element.insertBefore(each, element.children[index] ?? null);
      });
      setCurrent(focused === null ? current : written(focused));
      if (focused !== null && !element.contains(document.activeElement)) find(written(focused))?.focus();
    },
    /** A row has just run. @param {number} index */
    flash(index) {
      const row = shown[index]?.element;
      const said = row?.querySelector(".vpl-ran");
      if (row === undefined || !(said instanceof HTMLElement)) return;
      row.classList.add("ran");
      said.hidden = false;
      const time = String(Number(row.dataset.ran ?? 0) + 1);
      row.dataset.ran = time;
      setTimeout(() => row.dataset.ran === time && row.classList.remove("ran"), FLASH_MS);
      setTimeout(() => row.dataset.ran === time && (said.hidden = true), SAID_MS);
    },
  };
}

/** @param {number} index @param {Refusal | null} refusal @param {number | null} selected @param {HTMLElement} [row] */
function lookOf(index, refusal, selected, row) {
  const isWrong = refusal !== null && !refusal.hint && (refusal.row === index || refusal.other === index);
  const states = ["ran", "vpl-drop", "vpl-drop-no"].filter((name) => row?.classList.contains(name));
  return ["vpl-row", selected === index ? "selected" : "", isWrong ? "wrong" : "", ...states].filter(Boolean).join(" ");
}
