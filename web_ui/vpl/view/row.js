// One row of a program: its number, the places for blocks, what is wrong with it.

import { h } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { warningOf } from "../check.js";
import { palette } from "../mode.js";
import { isEmptyRow } from "../program.js";
import { picture } from "./picture.js";
import { written } from "./place.js";
import { sentence } from "./sentences.js";

/** @typedef {import("../../i18n/index.js").Translate} Translate */
/** @typedef {import("../blocks.js").Block} Block */
/** @typedef {import("../check.js").Refusal} Refusal */
/** @typedef {import("../program.js").Row} Row */
/** @typedef {import("./place.js").Slot} Slot */
/** @typedef {import("./rows.js").RowFacts} RowFacts */

/** @param {Translate} t @param {Readonly<Row>} row @param {number} index @param {RowFacts} facts */
export function drawRow(t, row, index, { program, refusal, selected }) {
  const isHere = refusal !== null && refusal.row === index;
  /** @param {Block | null} block @param {Slot} slot @param {number} at */
  const placed = (block, slot, at) => {
    const spot = { row: index, slot, index: at };
    if (block !== null) return blockButton(t, block, spot);
    const isEmpty = slot === "event" || row.actions.length === 0;
    return slotButton(t, spot, isHere && refusal.slot === slot && !refusal.hint && isEmpty);
  };
  /** The blocks of a place for several. @param {"conditions" | "actions"} slot */
  const blocks = (slot) => row[slot].map((block, at) => placed(block, slot, at));
  /** The place for one more block. @param {"conditions" | "actions"} slot */
  const more = (slot) => placed(null, slot, row[slot].length);
  const isLast = index === program.rows.length - 1 && isEmptyRow(row);
  const isFull = row.actions.length >= palette("action", program.mode).length;
  const isExtended = program.mode === "extended";
  const why = whyOf(t, row, index, refusal);
  return h(
    "li",
    { class: lookOfRow(index, refusal, selected), "data-row": index },
    numberButton(t, index, isLast),
    placed(row.event, "event", 0),
    ...(row.state === null ? [] : [placed(row.state, "state", 0)]),
    ...(isExtended ? [h("span", { class: "vpl-conditions" }, ...blocks("conditions"), more("conditions"))] : []),
    h("span", { class: "vpl-arrow", "aria-hidden": "true" }, icon("right", { small: true })),
    h("span", { class: "vpl-actions" }, ...blocks("actions"), ...(isFull ? [] : [more("actions")]), ...why),
    ...(isLast ? [] : [removeButton(t, index)]),
    h("span", { class: "chip vpl-ran", hidden: true }, icon("check", { small: true }), t("row.ran")),
  ); // prettier-ignore
}

/**
 * The classes of a row.
 *
 * @param {number} index
 * @param {Refusal | null} refusal
 * @param {number | null} selected
 * @param {HTMLElement} [row]   as it is shown: a row that has run, or below a dragged block, stays so
 */
export function lookOfRow(index, refusal, selected, row) {
  const isWrong = refusal !== null && !refusal.hint && (refusal.row === index || refusal.other === index);
  const states = ["ran", "vpl-drop", "vpl-drop-no"].filter((name) => row?.classList.contains(name));
  return ["vpl-row", selected === index ? "selected" : "", isWrong ? "wrong" : "", ...states].filter(Boolean).join(" ");
}

/** @param {Translate} t @param {Block} block @param {import("./place.js").Spot} spot */
function blockButton(t, block, spot) {
  const words = sentence(block, t);
  const button = h("button", {
    type: "button", class: "vpl-block", "data-place": written(spot), "data-block": block.name, "data-drag": "",
    "aria-label": words, title: words, "aria-haspopup": "dialog", tabindex: "-1",
  }); // prettier-ignore
  button.innerHTML = picture(block);
  return button;
}

/** @param {Translate} t @param {{ row: number, slot: Slot, index: number }} spot @param {boolean} isMissing */
function slotButton(t, spot, isMissing) {
  const words = t(`slot.${spot.slot}`, { row: spot.row + 1 });
  const look = `vpl-slot ${spot.slot}${isMissing ? " missing" : ""}`;
  const state = { "data-slot": spot.slot, "aria-label": words, title: words, "aria-pressed": "false", tabindex: "-1" };
  return h("button", { type: "button", class: look, "data-place": written(spot), ...state }, icon("add"));
}

/** @param {Translate} t @param {number} index @param {boolean} isLast */
function numberButton(t, index, isLast) {
  return h(
    "button",
    {
      type: "button", class: "vpl-number", "data-place": written({ row: index, slot: "row", index: 0 }), tabindex: "-1",
      "data-drag": isLast ? null : "", "aria-label": t("row.menu", { row: index + 1 }), "aria-haspopup": "menu",
    },
    String(index + 1),
  ); // prettier-ignore
}

/** @param {Translate} t @param {number} index */
function removeButton(t, index) {
  return h(
    "button",
    {
      type: "button", class: "btn icon vpl-remove", "data-place": written({ row: index, slot: "remove", index: 0 }),
      tabindex: "-1", "aria-label": t("row.remove", { row: index + 1 }), title: t("row.remove", { row: index + 1 }),
    },
    icon("remove", { small: true }),
  ); // prettier-ignore
}

/**
 * What is wrong in a row, beside the place where it is.
 *
 * @param {Translate} t
 * @param {Readonly<Row>} row
 * @param {number} index
 * @param {Refusal | null} refusal
 */
function whyOf(t, row, index, refusal) {
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
}
