// The foot of the text: how many mistakes there are or what became of a command, and how much room is left.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { makeSheet } from "../ui/sheet.js";

/** @typedef {[used: number, size: number]} Share */
/** @typedef {"good" | "warning" | "error" | ""} Kind */

/** @type {Readonly<Record<Kind, import("../ui/icons.js").IconName | null>>} */
const SIGNS = { good: "check", warning: "warning", error: "warning", "": null };
const NAMES = /** @type {const} */ (["variables", "bytecode", "stack"]);
/** More than this part of a memory is nearly all of it. */
const FULL = 0.9;

/** @param {Share} share  what is left, in whole percent */
function left([used, size]) {
  return Math.max(0, 100 - Math.round((100 * used) / Math.max(size, 1)));
}

/** @param {import("../i18n/index.js").Translate} t @param {() => void} go  goes to the position of the message */
export function footOf(t, go) {
  const sign = h("span", { class: "verdict-sign", "aria-hidden": "true" });
  const words = h("span", {});
  const verdict = h("button", { type: "button", class: "verdict", onclick: go }, sign, words);
  const long = h("span", { class: "room-long" });
  const short = h("span", { class: "room-short" });
  const room = h("button", { type: "button", class: "room", title: t("room.more"), hidden: true }, long, short);
  const sheet = h("div", { id: "room-sheet", class: "editor-room", role: "group", "aria-label": t("room.more") });
  const bars = NAMES.map((name) => {
    const meter = h("meter", { min: 0, "aria-label": t(`memory.${name}`) });
    const text = h("output", {});
    const element = h("div", { class: "memory" }, h("span", {}, t(`memory.${name}`)), text, meter);
    sheet.append(element);
    return { name, meter, text, element };
  });
  const element = h("div", { class: "editor-foot" }, verdict, h("span", { class: "grow" }), room, sheet);
  makeSheet(room, sheet);
  /** @type {Kind | null} */ let shown = null;
  return {
    element,
    /** @param {{ kind: Kind, text: string }} message */
    report({ kind, text }) {
      setText(words, text);
      if (kind === shown) return;
      shown = kind;
      setAttribute(verdict, "data-kind", kind);
      const name = SIGNS[kind];
      sign.replaceChildren(...(name === null ? [] : [icon(name, { small: true })]));
    },
    /** @param {Record<typeof NAMES[number], Share | null>} use   null: unknown */
    memories(use) {
      const { variables, bytecode } = use;
      room.hidden = variables === null || bytecode === null;
      if (variables !== null && bytecode !== null) {
        const shares = { variables: left(variables), program: left(bytecode) };
        setText(long, t("room", shares));
        setText(short, t("room.short", shares));
        setAttribute(room, "data-full", String([variables, bytecode].some(([used, size]) => used > FULL * size)));
      }
      for (const { name, meter, text, element } of bars) {
        const share = use[name];
        element.hidden = share === null;
        if (share === null) continue;
        const [used, size] = share;
        setText(text, `${used} / ${size}`);
        meter.max = Math.max(size, 1);
        meter.high = FULL * size;
        meter.value = used;
      }
    },
  };
}
