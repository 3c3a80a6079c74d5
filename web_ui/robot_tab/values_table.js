// The text form of the picture: every value in a table, SI units and Thymio's integers side by side.

import { copyText } from "../browser/clipboard.js";
import { localStore, trySetItem } from "../browser/local_storage.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { asText, groupsOf, joined } from "./sensor_rows.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

/** How long the button shows that the values were copied. */
const COPIED_MS = 2000;
/** Storage key: whether the table is open. */
const OPEN_KEY = "robot.values";
const OPEN = "open";

/** @param {Pick<import("../shell/context.js").Context, "text" | "language" | "announce" | "scene">} context */
export function valuesTable({ text, language, announce, scene }) {
  const t = text("robot");
  const stageText = text("stage");
  const table = new SensorTable(t);
  /** @type {Robot | null} */ let shown = null;
  const word = h("span", {}, t("numbers.copy"));
  const copy = h("button", { type: "button", class: "btn slim", "data-values": "copy" }, icon("copy", { small: true }), word);
  copy.addEventListener("click", async () => {
    if (shown === null) return;
    const result = t((await copyText(asText(table.groups, shown))) ? "numbers.copied" : "numbers.notCopied");
    announce(result);
    setText(word, result);
    setTimeout(() => setText(word, t("numbers.copy")), COPIED_MS);
  });
  const count = h("span", { class: "small muted count" });
  const element = h(
    "details",
    { class: "disc", id: "values", open: localStore.getItem(OPEN_KEY) === OPEN },
    h(
      "summary",
      {},
      icon("list", { small: true }),
      h("span", { class: "grow" }, t("numbers")),
      count,
      h("span", { class: "turns" }, icon("caretDown", { small: true })),
    ),
    copy,
    table.element,
  );
  element.addEventListener("toggle", () => {
    trySetItem(localStore, OPEN_KEY, element.open ? OPEN : "closed");
    if (shown !== null && element.open) table.show(shown);
    scene.invalidate();
  });
  /** @type {readonly import("../state/index.js").SensorInfo[] | null} */ let declared = null;
  let hadLidar = false;
  return {
    element,
    /** @param {Robot} robot @param {readonly import("../state/index.js").SensorInfo[]} sensors */
    show(robot, sensors) {
      if (sensors !== declared || robot.hasLidar !== hadLidar) {
        declared = sensors;
        hadLidar = robot.hasLidar;
        table.setGroups(groupsOf({ robotText: t, stageText }, language, sensors, robot));
        setText(count, t("numbers.count", { count: table.cells.length }));
      }
      shown = robot;
      if (element.open) table.show(robot);
    },
  };
}

/** The table of groups of rows, and the values in it. */
class SensorTable {
  /** @param {import("../i18n/index.js").Translate} t */
  constructor(t) {
    /** @type {import("./sensor_rows.js").Group[]} */ this.groups = [];
    /** @type {Cells[]} */ this.cells = [];
    const titles = ["sensors.sensor", "sensors.value", "sensors.raw"].map((key) => h("th", { scope: "col" }, t(key)));
    this.element = h("table", { class: "values" }, h("thead", {}, h("tr", {}, ...titles)));
  }

  /** @param {import("./sensor_rows.js").Group[]} groups */
  setGroups(groups) {
    this.groups = groups;
    this.cells = [];
    const bodies = groups.map(([title, rows]) => {
      const cells = rows.map(cellsOf);
      this.cells.push(...cells);
      const heading = h("tr", { class: "group" }, h("th", { colspan: 3, scope: "rowgroup" }, title));
      return h("tbody", {}, heading, ...cells.map(({ element }) => element));
    });
    this.element.replaceChildren(this.element.children[0], ...bodies);
  }

  /** @param {Robot} robot */
  show(robot) {
    for (const { row, value, raw, bar } of this.cells) {
      const words = row.words(robot);
      setText(value, row.value(robot));
      setText(raw, joined(words));
      const largest = Math.max(0, ...words.map((word) => Math.abs(word ?? 0)));
      const share = row.full === null ? 0 : Math.min(1, largest / row.full);
      setAttribute(bar, "style", `--share: ${share.toFixed(2)}`);
    }
  }
}

/** @typedef {ReturnType<typeof cellsOf>} Cells */

/** @param {import("./sensor_rows.js").Row} row */
function cellsOf(row) {
  const value = h("td", {});
  const raw = h("span", {});
  const bar = h("td", { class: "raw" }, raw);
  return { row, element: h("tr", {}, h("th", { scope: "row" }, row.label), value, bar), value, raw, bar };
}
