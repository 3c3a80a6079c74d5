// The sheet with the stimuli that have values: tilt, noise, light, temperature, battery, remote control, pen.

import { disabledReason } from "../../state/disabled_reason.js";
import { h, lock } from "../../ui/dom.js";
import { icon } from "../../ui/icons.js";
import { makeSheet } from "../../ui/sheet.js";

/** @typedef {import("../../shell/context.js").Context} Context */

/** Keys of a remote control and their RC5 commands; the arrows correspond to the robot's buttons. */
const KEYS = /** @type {[string, number][]} */ ([
  ["1", 1],
  ["2", 2],
  ["3", 3],
  ["4", 4],
  ["5", 5],
  ["6", 6],
  ["7", 7],
  ["8", 8],
  ["9", 9],
  ["◀", 85],
  ["0", 0],
  ["▶", 86],
  ["▲", 80],
  ["●", 87],
  ["▼", 81],
]);

/** Labels of the keys without a digit. */
const KEY_NAMES = /** @type {Record<number, string>} */ ({
  80: "button.forward",
  81: "button.backward",
  85: "button.left",
  86: "button.right",
  87: "button.center",
});

const DEGREE = Math.PI / 180;

/**
 * Sliders: minimum, maximum, step, initial value, unit, and the message they publish.
 *
 * @type {{ name: string, low: number, high: number, step: number, start: number, unit: string,
 *   send: (value: number, other: (name: string) => number) => [topic: string, type: string, value: any] }[]}
 */
const SLIDERS = [
  { name: "noise", low: 0, high: 100, step: 1, start: 0, unit: "%", send: (value) => level("_press/sound", value) },
  { name: "light", low: 0, high: 100, step: 1, start: 0, unit: "%", send: (value) => level("_press/light", value) },
  {
    name: "temperature",
    low: -10,
    high: 50,
    step: 0.5,
    start: 22,
    unit: "°C",
    send: (value) => ["_press/temperature", "std_msgs/msg/Float32", { data: value }],
  },
  {
    name: "battery",
    low: 3.2,
    high: 4.2,
    step: 0.05,
    start: 4,
    unit: "V",
    send: (value) => ["_press/battery", "std_msgs/msg/Float32", { data: value }],
  },
  { name: "roll", low: -60, high: 60, step: 1, start: 0, unit: "°", send: (roll, other) => tilt(roll, other("pitch")) },
  {
    name: "pitch",
    low: -60,
    high: 60,
    step: 1,
    start: 0,
    unit: "°",
    send: (pitch, other) => tilt(other("roll"), pitch),
  },
];

/** @param {string} topic @param {number} percent @returns {[string, string, any]} */
function level(topic, percent) {
  return [topic, "std_msgs/msg/Float32", { data: percent / 100 }];
}

/** @param {number} roll @param {number} pitch  degrees @returns {[string, string, any]} */
function tilt(roll, pitch) {
  return ["_press/tilt", "std_msgs/msg/Float32MultiArray", { data: [roll * DEGREE, pitch * DEGREE] }];
}

/** @param {Context} context */
export function moreStimuli({ text, actions, store }) {
  const t = text("stage");
  const pageText = text("page");
  /** The last settings of each robot; no topic reports them. @type {Map<string, Record<string, number>>} */
  const settings = new Map();
  const setting = () => {
    const { selected } = store.state;
    const found = settings.get(selected) ?? Object.fromEntries(SLIDERS.map(({ name, start }) => [name, start]));
    settings.set(selected, found);
    return found;
  };

  const sliders = SLIDERS.map(({ name, low, high, step, unit, send }) => {
    const input = h("input", { type: "range", min: low, max: high, step, "data-operate": name });
    const shown = h("output");
    const show = (/** @type {number} */ value) => {
      shown.textContent = `${value} ${unit}`;
      input.setAttribute("aria-valuetext", shown.textContent);
    };
    input.addEventListener("input", () => {
      const values = setting();
      values[name] = Number(input.value);
      show(values[name]);
      actions.operate(...send(values[name], (other) => values[other]));
    });
    return {
      element: h("label", { class: "slider" }, h("span", {}, t(`stimuli.${name}`)), input, shown),
      refresh: () => {
        const value = setting()[name];
        input.value = String(value);
        show(value);
      },
    };
  });

  const remote = h(
    "div",
    { class: "keypad", role: "group", "aria-label": t("stimuli.remote") },
    ...KEYS.map(([sign, command]) =>
      h(
        "button",
        {
          type: "button",
          class: "btn line",
          "data-key": command,
          "aria-label": command in KEY_NAMES ? t(KEY_NAMES[command]) : sign,
          onclick: () => actions.operate("_press/remote", "std_msgs/msg/Int8", { data: command }),
        },
        sign,
      ),
    ),
  );

  const controls = h(
    "fieldset",
    { "aria-label": t("stimuli") },
    ...sliders.map(({ element }) => element),
    h("h3", {}, t("stimuli.remote")),
    remote,
    h("h3", {}, t("pen")),
    ...pen(t, actions),
  );
  const sheet = h("div", { id: "hands-sheet", class: "stimuli" }, controls);
  const button = h(
    "button",
    { type: "button", class: "hand", "data-hand": "more", id: "hands-more" },
    icon("more"),
    h("span", {}, pageText("more")),
  );
  makeSheet(button, sheet);
  /** @type {string | null} */ let robot = null;
  return {
    element: h("span", { class: "menu" }, button, sheet),
    /** @param {import("../../state/index.js").State} state */
    render({ connection, readOnly, selected }) {
      lock(controls, disabledReason({ connection, readOnly }, pageText));
      if (selected === robot) return;
      robot = selected;
      for (const { refresh } of sliders) refresh();
    },
  };
}

/** The pen in the hole between the wheels. @param {import("../../i18n/index.js").Translate} t @param {Context["actions"]} actions */
function pen(t, actions) {
  const color = h("input", { type: "color", value: "#c0182a", "aria-label": t("pen.color"), title: t("pen.color") });
  const range = { min: 1, max: 100, step: 1, value: 10 };
  const width = h("input", { type: "number", class: "input", "aria-label": t("pen.width"), ...range });
  const choose = (/** @type {string} */ tool) => {
    if (width.value !== "" && width.checkValidity()) {
      actions.operate("_pen/width", "std_msgs/msg/Float32", { data: Number(width.value) / 1000 });
    }
    const [r, g, b] = [1, 3, 5].map((at) => parseInt(color.value.slice(at, at + 2), 16) / 255);
    actions.operate("_pen/color", "std_msgs/msg/ColorRGBA", { r, g, b, a: tool === "eraser" ? 0 : 1 });
    actions.operate("pen/down", "std_msgs/msg/Bool", { data: tool !== "up" });
  };
  const tools = h(
    "select",
    { class: "select", "aria-label": t("pen"), "data-operate": "pen" },
    ...["up", "down", "eraser"].map((tool) => h("option", { value: tool }, t(`pen.${tool}`))),
  );
  for (const input of [tools, color, width]) input.addEventListener("change", () => choose(tools.value));
  return [
    h("div", { class: "row" }, tools, color, h("label", { class: "width" }, width, h("span", {}, "mm"))),
  ];
}
