// The sensor panel: SI values and Thymio's integers side by side.

import { card } from "./card.js";
import { h, setAttribute, setText } from "./dom.js";
import { asText, groupsOf } from "./sensor_rows.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

/** How long the button shows that the values were copied. */
const COPIED_MS = 2000;

/** @param {import("./index.js").Context} context @returns {import("./index.js").Panel} */
export function sensorsPanel({ t, store, announce }) {
  const groups = groupsOf(t);
  const rows = groups.map(([title, list]) => ({
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
  let frozen = false;
  const freeze = h("button", { type: "button", "aria-pressed": "false", "data-values": "freeze" }, t("sensors.freeze"));
  freeze.addEventListener("click", () => {
    frozen = !frozen;
    setAttribute(freeze, "aria-pressed", String(frozen));
    if (!frozen) show(store.state.robots[store.state.selected]);
  });
  const copy = h("button", { type: "button", "data-values": "copy" }, t("sensors.copy"));
  copy.addEventListener("click", async () => {
    if (shown === undefined) return;
    const done = await copyText(asText(groups, shown));
    announce(t(done ? "sensors.copied" : "sensors.notCopied"));
    setText(copy, t(done ? "sensors.copied" : "sensors.notCopied"));
    setTimeout(() => setText(copy, t("sensors.copy")), COPIED_MS);
  });
  const waiting = h("small", { class: "waiting", hidden: true }, t("sensors.waiting"));
  const element = card("sensors", t("sensors"), h("div", { class: "row verbs" }, freeze, copy), waiting, table);
  /** @type {Robot | undefined} */ let shown;
  /** @param {Robot | undefined} robot */
  const show = (robot) => {
    if (robot === undefined) return;
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
  };
  return {
    slot: "side",
    element,
    render({ robots, selected, simulator }) {
      const robot = robots[selected];
      waiting.hidden = !simulator?.paused || robot === undefined || Object.keys(robot.raw).length > 0;
      if (frozen || robot === shown || !element.open) return;
      show(robot);
    },
  };
}

/** @param {string} label */
function cellsOf(label) {
  const value = h("td", {});
  const raw = h("span", {});
  const bar = h("td", { class: "raw" }, raw);
  return { element: h("tr", {}, h("th", { scope: "row" }, label), value, bar), value, raw, bar };
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
  const field = h("textarea", { class: "unseen", "aria-hidden": "true" });
  field.value = text;
  document.body.append(field);
  field.select();
  const done = document.execCommand("copy");
  field.remove();
  return done;
}
