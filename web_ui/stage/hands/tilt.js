// Tilt: the robot is held at an angle until it is level again.

import { h } from "../../ui/dom.js";
import { HandSettings } from "./settings.js";
import { sheetHand } from "./sheet_hand.js";
import { slider } from "./slider.js";

const DEGREE = Math.PI / 180;
const MOST = 60;

/** @param {import("../../shell/context.js").Context} context @returns {import("./index.js").Hand} */
export function tiltHand({ text, actions, store }) {
  const t = text("stage");
  const settings = new HandSettings(store, { roll: 0, pitch: 0 });
  /** @param {{ roll?: number, pitch?: number }} changes  degrees */
  const tilt = (changes) => {
    settings.change(changes);
    const { roll, pitch } = settings.now;
    actions.operate("_press/tilt", "std_msgs/msg/Float32MultiArray", { data: [roll * DEGREE, pitch * DEGREE] });
  };
  const range = { low: -MOST, high: MOST, step: 1, unit: "°" };
  const roll = slider({ ...range, name: "roll", label: t("hand.tilt.side") }, (value) => tilt({ roll: value }));
  const pitch = slider({ ...range, name: "pitch", label: t("hand.tilt.front") }, (value) => tilt({ pitch: value }));
  const refresh = () => {
    roll.show(settings.now.roll);
    pitch.show(settings.now.pitch);
  };
  const level = () => {
    tilt({ roll: 0, pitch: 0 });
    refresh();
  };
  return sheetHand({
    name: "tilt",
    drawing: "tilt",
    t,
    content: [
      roll.element,
      pitch.element,
      h("button", { type: "button", class: "btn line", "data-operate": "level", onclick: level }, t("hand.tilt.level")),
    ],
    isHeld: () => settings.now.roll !== 0 || settings.now.pitch !== 0,
    refresh,
  });
}
