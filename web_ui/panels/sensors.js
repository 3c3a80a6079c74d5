// What the robot measures: SI values and Thymio's own integers side by side.

import { BUTTONS, GROUND, PROXIMITY } from "../state/names.js";
import { card } from "./card.js";
import { h, setAttribute, setText } from "./dom.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/** @typedef {{ label: string, value: (robot: Robot) => string, raw: (robot: Robot) => number | undefined, full: number }} Row */

const WHEEL_RADIUS_M = 0.022;
const PROXIMITY_FULL = 4505;
const GROUND_FULL = 1023;

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function sensorsPanel({ t }) {
  const rows = groups(t).map(([title, list]) => ({
    title,
    cells: list.map((row) => ({ row, ...cellsOf(row.label) })),
  }));
  const table = h(
    "table",
    {},
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("th", { scope: "col" }, t("sensors.sensor")),
        h("th", { scope: "col" }, t("sensors.value")),
        h("th", { scope: "col" }, t("sensors.raw")),
      ),
    ),
    ...rows.map(({ title, cells }) =>
      h(
        "tbody",
        {},
        h("tr", { class: "group" }, h("th", { colspan: 3, scope: "rowgroup" }, title)),
        ...cells.map(({ element }) => element),
      ),
    ),
  );
  const element = card("sensors", t("sensors"), table);
  /** @type {Robot | undefined} */ let shown;
  return {
    slot: "side",
    element,
    render({ robots, selected }) {
      const robot = robots[selected];
      if (robot === undefined || robot === shown || !element.open) return;
      shown = robot;
      for (const { cells } of rows) {
        for (const { row, value, raw, bar } of cells) {
          const count = row.raw(robot);
          setText(value, row.value(robot));
          setText(raw, count === undefined ? "" : String(count));
          const share = Math.min(1, Math.abs(count ?? 0) / row.full);
          setAttribute(bar, "style", `--share: ${share.toFixed(2)}`);
        }
      }
    },
  };
}

/** @param {import("../i18n/index.js").Translate} t @returns {[string, Row[]][]} */
function groups(t) {
  return [
    [
      t("sensors.proximity"),
      PROXIMITY.map((name, index) => ({
        label: t(`proximity.${name}`),
        value: ({ proximity }) => formatRange(proximity[name], t),
        raw: ({ raw }) => raw.proximity?.[index],
        full: PROXIMITY_FULL,
      })),
    ],
    [
      t("sensors.ground"),
      GROUND.map((name, index) => ({
        label: t(`side.${name}`),
        value: ({ ground }) =>
          ground[name] === undefined ? "" : t(isBright(ground[name]) ? "sensors.bright" : "sensors.dark"),
        raw: ({ raw }) => raw.ground?.[4 + index],
        full: GROUND_FULL,
      })),
    ],
    [
      t("sensors.motors"),
      /** @type {const} */ (["left", "right"]).map((side, index) => ({
        label: t(`side.${side}`),
        value: ({ wheelSpeeds }) => `${(wheelSpeeds[side] * WHEEL_RADIUS_M * 100).toFixed(1)} cm/s`,
        raw: ({ raw }) => raw.motor?.[index],
        full: 500,
      })),
    ],
    [
      t("sensors.buttons"),
      BUTTONS.map((name) => ({
        label: t(`button.${name}`),
        value: ({ buttons }) => t(buttons[name] ? "sensors.pressed" : "sensors.released"),
        raw: ({ buttons }) => Number(buttons[name]),
        full: 1,
      })),
    ],
  ];
}

/** @param {string} label */
function cellsOf(label) {
  const value = h("td", {});
  const raw = h("span", {});
  const bar = h("td", { class: "raw" }, raw);
  return { element: h("tr", {}, h("th", { scope: "row" }, label), value, bar), value, raw, bar };
}

/**
 * Reflecting ground is told as "too close" (−inf) or, as the driver does, 0 (ros-interface.md 4.3).
 *
 * @param {number} range
 */
function isBright(range) {
  return range <= 0;
}

/** @param {number | undefined} range @param {import("../i18n/index.js").Translate} t */
function formatRange(range, t) {
  if (range === undefined) return "";
  if (range === Infinity || (range < 0 && range !== -Infinity)) return t("sensors.nothing");
  return range === -Infinity ? "< 2.2 cm" : `${(range * 100).toFixed(1)} cm`;
}
