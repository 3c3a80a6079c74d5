// The surroundings of the robot: noise, light and warmth; and the charge of its battery.

import { HandSettings } from "./settings.js";
import { sheetHand } from "./sheet_hand.js";
import { slider } from "./slider.js";

const PERCENT = { size: 0.01, low: 0, high: 100, step: 1, unit: "%", start: 0 };
/** Topics, the size of the unit in that of the message, and keys of the names. */
const RANGES = [
  { ...PERCENT, name: "noise", key: "noise", topic: "_press/sound" },
  { ...PERCENT, name: "light", key: "light", topic: "_press/light" },
  {
    name: "temperature",
    key: "warmth",
    topic: "_press/temperature",
    ...{ size: 1, low: -10, high: 50, step: 0.5, unit: "°C", start: 22 },
  },
  { name: "battery", key: "battery", topic: "_press/battery", size: 1, low: 3.2, high: 4.2, step: 0.05, unit: "V", start: 4 },
];

/** @param {import("../../shell/context.js").Context} context @returns {import("./index.js").Hand} */
export function roomHand({ text, actions, store }) {
  const t = text("stage");
  const start = Object.fromEntries(RANGES.map(({ name, start: value }) => [name, value]));
  const settings = new HandSettings(store, start);
  const sliders = RANGES.map((range) => ({
    name: range.name,
    control: slider({ ...range, label: t(`hand.room.${range.key}`) }, (value) => {
      settings.change({ [range.name]: value });
      actions.operate(range.topic, "std_msgs/msg/Float32", { data: value * range.size });
    }),
  }));
  return sheetHand({
    name: "room",
    drawing: "warmth",
    t,
    content: sliders.map(({ control }) => control.element),
    isHeld: () => RANGES.some(({ name }) => settings.now[name] !== start[name]),
    refresh: () => {
      for (const { name, control } of sliders) control.show(settings.now[name]);
    },
  });
}
