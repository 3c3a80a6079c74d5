// The picture of the robot from above: what it notices (orange), and what it does (blue).

import { BUTTONS, GROUND, PROXIMITY } from "../state/names.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import {
  barPath,
  BARS,
  BUTTONS_AT,
  HULL,
  motorPath,
  MOTORS,
  PEN_AT,
  ringPath,
  SIZE,
  STRIP_LENGTH,
  STRIPS,
  WHEELS,
} from "./picture_shape.js";

/** @typedef {import("./picture_values.js").PictureValues} PictureValues */
/** @typedef {import("../i18n/index.js").Translate} Translate */

const FULL = 1;
/** Angles of the buttons' arrows; the center is a disc. */
const TURNS = /** @type {Record<string, number>} */ ({ forward: 0, right: 90, backward: 180, left: 270 });
/** What is shown for a value that has not been received. */
const UNKNOWN = "–";
const GROUND_COLORS = { white: "var(--paper)", gray: "var(--paper-gray)", black: "var(--tape)" };
const RING_LIGHTS = 8;

/**
 * @param {string} tag
 * @param {Record<string, string | number>} [attributes]
 * @param {...(Element | string)} children
 */
function s(tag, attributes = {}, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) element.setAttribute(name, String(value));
  element.append(...children);
  return element;
}

/** @param {Translate} t  texts of the robot */
export function robotPicture(t) {
  const bars = BARS.map((bar, index) => barOf(bar, t("front.side", { number: index, place: t(`proximity.${PROXIMITY[index]}`) }), index));
  const motors = /** @type {const} */ ([0, 1]).map((side) => motorOf(side, t(side === 0 ? "motor.left" : "motor.right")));
  const ring = Array.from({ length: RING_LIGHTS }, (_, index) => s("path", { class: "ring-light", d: ringPath(index) }));
  const buttons = BUTTONS.map((name) => ({ name, shape: buttonOf(name) }));
  const strips = STRIPS.map(([x, y]) => s("path", { class: "strip", d: `M${x} ${y}v${STRIP_LENGTH}` }));
  const shell = s("path", { class: "shine", d: HULL });
  const drawing = s(
    "svg",
    { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, role: "img", "aria-label": t("picture") },
    s("defs", {}, ...gradients()),
    ...bars.map(({ element }) => element),
    s("g", { class: "wheels" }, ...WHEELS.map(([x, y]) => s("rect", { x, y, width: 18, height: 66, rx: 7 }))),
    ...strips,
    s("path", { class: "hull", d: HULL }),
    shell,
    ...BARS.map(({ window: [x, y, turn, width] }) =>
      s("rect", {
        class: "window",
        x: x - width / 2,
        y: y - 4,
        width,
        height: 8,
        rx: 2.5,
        transform: `rotate(${turn} ${x} ${y})`,
      }),
    ),
    s("g", { class: "ring" }, ...ring),
    s("g", { class: "buttons" }, ...buttons.map(({ shape }) => shape)),
    s("circle", { class: "pen-hole", cx: PEN_AT.x, cy: PEN_AT.y, r: 8 }),
    ...motors.map(({ element }) => element),
  );
  const eyes = GROUND.map((side) => eyeOf(side));
  const lamps = /** @type {const} */ (["top", "ring", "below"]).map((name) => ({ name, ...lampOf(name, t(`light.${name}`)) }));
  const element = h(
    "figure",
    { class: "picture" },
    drawing,
    h(
      "div",
      { class: "eyes" },
      h("span", { class: "cap" }, t("ground")),
      h("div", { class: "row" }, ...eyes.map((eye) => eye.element)),
    ),
    h(
      "div",
      { class: "lamps" },
      h("span", { class: "cap" }, t("lights")),
      h("div", { class: "row" }, ...lamps.map((lamp) => lamp.element)),
    ),
  );
  return {
    element,
    /** @param {PictureValues} values */
    show({ proximity, ground, motors: speeds, buttons: pressed, ring: levels, top, below }) {
      proximity.forEach((reading, index) => bars[index].show(reading));
      speeds.forEach((reading, side) => motors[side].show(reading));
      ground.forEach(({ count, shade }, side) => eyes[side].show(count, shade, shade === null ? "" : t(`ground.${shade}`)));
      levels.forEach((level, index) => setAttribute(ring[index], "style", level > 0 ? `--level: ${level.toFixed(2)}` : ""));
      for (const { name, shape } of buttons) setAttribute(shape, "data-pressed", String(pressed[name]));
      setAttribute(shell, "style", `--level: ${top.level.toFixed(2)}`);
      setAttribute(drawing, "style", top.level > 0 ? `--color: ${top.color}` : "");
      below.forEach((light, side) => setAttribute(strips[side], "style", styleOf(light)));
      const ringLevel = Math.max(0, ...levels);
      const belowLight = below[0].level >= below[1].level ? below[0] : below[1];
      const shown = { top, ring: { color: ringLevel > 0 ? "var(--ring)" : "", level: ringLevel }, below: belowLight };
      for (const { name, show } of lamps) show(shown[name]);
    },
  };
}

/** @param {import("./picture_values.js").Light} light */
function styleOf({ color, level }) {
  return level > 0 ? `--color: ${color}; --level: ${level.toFixed(2)}` : "";
}

/** The body's own shading, and the light of the top lamp in it. */
function gradients() {
  return [
    s(
      "linearGradient",
      { id: "picture-body", x1: 0, y1: 0, x2: 0.6, y2: 1 },
      s("stop", { offset: 0, class: "body-light" }),
      s("stop", { offset: 1, class: "body-dark" }),
    ),
    s(
      "radialGradient",
      { id: "picture-shine", cx: 0.5, cy: 0.52, r: 0.62 },
      s("stop", { offset: 0.5, class: "shine-center" }),
      s("stop", { offset: 1, class: "shine-rim" }),
    ),
  ];
}

/** @param {import("./picture_shape.js").Bar} bar @param {string} title @param {number} index */
function barOf(bar, title, index) {
  const fill = s("path", { class: "fill", d: "" });
  const [x, y] = bar.label;
  const number = s("text", { class: "number", x, y, "text-anchor": "middle" }, UNKNOWN);
  const element = s(
    "g",
    { class: "proximity", "data-index": index },
    s("title", {}, title),
    s("path", { class: "slot", d: barPath(bar, FULL) }),
    fill,
    number,
  );
  return {
    element,
    /** @param {import("./picture_values.js").Reading} reading */
    show({ count, share }) {
      setAttribute(fill, "d", barPath(bar, share));
      setText(number, count === null ? UNKNOWN : String(count));
    },
  };
}

/** @param {0 | 1} side @param {string} title */
function motorOf(side, title) {
  const { x, y, half } = MOTORS;
  const fill = s("path", { class: "fill act", d: "" });
  const isLeft = side === 0;
  const number = s(
    "text",
    { class: "number act", x: x[side] + (isLeft ? -14 : 14), y: y + 5, "text-anchor": isLeft ? "end" : "start" },
    UNKNOWN,
  );
  const element = s(
    "g",
    { class: "motor", "data-side": isLeft ? "left" : "right" },
    s("title", {}, title),
    s("path", { class: "slot act", d: `M${x[side]} ${y - half}v${2 * half}` }),
    fill,
    s("circle", { class: "zero", cx: x[side], cy: y, r: 2.5 }),
    number,
  );
  return {
    element,
    /** @param {import("./picture_values.js").Reading} reading */
    show({ count, share }) {
      setAttribute(fill, "d", motorPath(side, share));
      setText(number, count === null ? UNKNOWN : String(count));
    },
  };
}

/** @param {string} name */
function buttonOf(name) {
  const { x, y } = BUTTONS_AT;
  if (!(name in TURNS)) return s("circle", { class: "button", "data-button-mark": name, cx: x, cy: y, r: 8.5 });
  return s("path", {
    class: "button",
    "data-button-mark": name,
    d: "M0 -29L9.5 -16.5L-9.5 -16.5Z",
    transform: `translate(${x} ${y}) rotate(${TURNS[name]})`,
  });
}

/** @param {string} side */
function eyeOf(side) {
  const disc = h("i", { "aria-hidden": "true" });
  const number = h("b", { class: "num" }, UNKNOWN);
  const word = h("span", { class: "tiny muted" });
  return {
    element: h("span", { class: "ground-eye", "data-side": side }, disc, number, word),
    /** @param {number | null} count @param {import("./picture_values.js").Shade | null} shade @param {string} name */
    show(count, shade, name) {
      setAttribute(disc, "style", shade === null ? "" : `--color: ${GROUND_COLORS[shade]}`);
      setText(number, count === null ? UNKNOWN : String(count));
      setText(word, name);
    },
  };
}

/** @param {string} name @param {string} title */
function lampOf(name, title) {
  const disc = h("i", { "aria-hidden": "true" });
  return {
    element: h("span", { class: "lamp-light", "data-light": name }, disc, h("span", { class: "tiny muted" }, title)),
    /** @param {import("./picture_values.js").Light} light */
    show(light) {
      setAttribute(disc, "style", styleOf(light));
    },
  };
}
