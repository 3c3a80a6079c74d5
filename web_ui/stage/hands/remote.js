// The remote control: its keys send RC5 commands; the arrows correspond to the robot's buttons.

import { h } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { sheetHand } from "./sheet_hand.js";

/** @typedef {"forward" | "backward" | "left" | "right" | "center"} Arrow */

const KEYS = /** @type {readonly [digit: string | null, command: number, arrow?: Arrow][]} */ ([
  ["1", 1],
  ["2", 2],
  ["3", 3],
  ["4", 4],
  ["5", 5],
  ["6", 6],
  ["7", 7],
  ["8", 8],
  ["9", 9],
  [null, 85, "left"],
  ["0", 0],
  [null, 86, "right"],
  [null, 80, "forward"],
  [null, 87, "center"],
  [null, 81, "backward"],
]);

/** @param {import("../../shell/context.js").Context} context @returns {import("./index.js").Hand} */
export function remoteHand({ text, actions }) {
  const t = text("stage");
  const keys = KEYS.map(([digit, command, arrow]) => {
    const label = arrow === undefined ? digit : t(`button.${arrow}`);
    const send = () => actions.operate("_press/remote", "std_msgs/msg/Int8", { data: command });
    return h(
      "button",
      { type: "button", class: "btn line", "data-key": command, "aria-label": label, title: label, onclick: send },
      arrow === undefined ? String(digit) : icon(arrow),
    );
  });
  return sheetHand({
    name: "remote",
    drawing: "remote",
    t,
    content: [h("div", { class: "keypad", role: "group", "aria-label": t("hand.remote") }, ...keys)],
  });
}
