// The sensor values as a table: SI values and Thymio's integers side by side.

import { localStore, trySetItem } from "../browser/local_storage.js";
import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { asText, groupsOf, joined } from "./sensor_rows.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

/** How long the button shows that the values were copied. */
const COPIED_MS = 2000;
/** Storage key: whether the table is folded. */
const FOLDED_KEY = "robot.values";

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function valuesPanel({ text, language, store, workspace, announce }) {
  const t = text("robot");
  const table = new SensorTable(t);
  let frozen = false;
  const freeze = h(
    "button",
    { type: "button", class: "btn line", "aria-pressed": "false", "data-values": "hold" },
    t("sensors.freeze"),
  );
  freeze.addEventListener("click", () => {
    frozen = !frozen;
    setAttribute(freeze, "aria-pressed", String(frozen));
    if (!frozen) show(store.state.robots[store.state.selected]);
  });
  const copy = h("button", { type: "button", class: "btn line", "data-values": "copy" }, t("sensors.copy"));
  copy.addEventListener("click", async () => {
    if (shown === undefined) return;
    const done = await copyText(asText(table.groups, shown));
    announce(t(done ? "sensors.copied" : "sensors.notCopied"));
    setText(copy, t(done ? "sensors.copied" : "sensors.notCopied"));
    setTimeout(() => setText(copy, t("sensors.copy")), COPIED_MS);
  });
  const waiting = h("small", { class: "waiting muted", hidden: true }, t("sensors.waiting"));
  const element = h(
    "details",
    { class: "disc", id: "values", open: localStore.getItem(FOLDED_KEY) !== "closed" },
    h(
      "summary",
      {},
      icon("list", { small: true }),
      h("span", {}, t("sensors")),
      h("span", { class: "turns" }, icon("caretDown", { small: true })),
    ),
    h("div", { class: "row" }, freeze, copy),
    waiting,
    table.element,
  );
  // Values that no other part of the page needs are subscribed to while they are visible.
  const reportShown = () => {
    const shown = element.open && workspace.tab === "robot";
    if (store.state.sensorsShown !== shown) store.dispatch({ type: "showSensors", shown });
  };
  element.addEventListener("toggle", () => {
    trySetItem(localStore, FOLDED_KEY, element.open ? "open" : "closed");
    reportShown();
  });
  /** @type {Robot | undefined} */ let shown;
  /** @type {readonly import("../state/index.js").SensorInfo[] | undefined} */ let declared;
  /** @param {Robot | undefined} robot */
  const show = (robot) => {
    if (robot === undefined) return;
    shown = robot;
    table.show(robot);
  };
  return {
    slot: "robot",
    element,
    watch: reportShown,
    render({ robots, selected, simulator, sensors }) {
      const robot = robots[selected];
      waiting.hidden = !simulator?.paused || robot === undefined || Object.keys(robot.raw).length > 0;
      if (sensors !== declared) {
        declared = sensors;
        table.setGroups(groupsOf(t, language, sensors));
        if (shown !== undefined) table.show(shown);
      }
      if (frozen || robot === shown || !element.open) return;
      show(robot);
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

/**
 * Copy text to the clipboard. Pages that are not from this machine have no clipboard API, so a selection is used
 * there.
 *
 * @param {string} text
 */
async function copyText(text) {
  if (navigator.clipboard !== undefined) {
    const written = await navigator.clipboard.writeText(text).then(
      () => true,
      () => false,
    );
    if (written) return true;
  }
  const field = h("textarea", { class: "vh", "aria-hidden": "true" });
  field.value = text;
  document.body.append(field);
  field.select();
  const done = document.execCommand("copy");
  field.remove();
  return done;
}
