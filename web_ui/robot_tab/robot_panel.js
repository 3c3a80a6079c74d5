// The tab "Robot": what the chosen robot notices and does, as a picture, as four values, and as a table.

import { h, setAttribute, setText } from "../ui/dom.js";
import { icon } from "../ui/icons.js";
import { robotPicture } from "./picture.js";
import { pictureOf } from "./picture_values.js";
import { robotStats } from "./stats.js";
import { valuesTable } from "./values_table.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

/** At most 20 pictures a second: people do not read faster. */
const LEAST_MS = 50;

/** @param {import("../shell/context.js").Context} context @returns {import("../shell/context.js").Panel} */
export function robotPanel(context) {
  const { text, store, workspace, scene } = context;
  const t = text("robot");
  const picture = robotPicture(t);
  const stats = robotStats(t);
  const table = valuesTable(context);
  /** @typedef {{ name: string, robot: Robot }} Shown */
  /** @type {Shown | null} */ let shown = null;
  /** @type {Shown | null} what was shown when the values were held */ let held = null;
  const word = h("span", {}, t("hold"));
  const hold = h(
    "button",
    { type: "button", class: "btn line slim", "aria-pressed": "false", "data-values": "hold" },
    icon("pin", { small: true }),
    word,
  );
  /** @param {Shown | null} now */
  const keep = (now) => {
    held = now;
    setAttribute(hold, "aria-pressed", String(held !== null));
    setText(word, t(held === null ? "hold" : "hold.on"));
  };
  hold.addEventListener("click", () => {
    // not the newest values, which may not be in the picture yet: it would still change
    keep(held === null && shown?.name === store.state.selected ? shown : null);
    scene.invalidate();
  });
  const waiting = h("p", { class: "waiting small muted", hidden: true }, t("waiting"));
  const element = h(
    "div",
    { class: "robot-parts" },
    h(
      "div",
      { class: "row" },
      h(
        "p",
        { class: "legend grow" },
        h("span", { class: "legend-sense" }, h("i", {}), t("legend.sense")),
        h("span", { class: "legend-act" }, h("i", {}), t("legend.act")),
      ),
      hold,
    ),
    waiting,
    picture.element,
    stats.element,
    table.element,
  );
  /** @type {readonly unknown[]} */ let declared = [];
  let shownMs = -Infinity;
  let isLate = false;
  return {
    slot: "robot",
    element,
    /** Values that no other part of the page needs are subscribed to while this tab is open. */
    watch() {
      const isShown = workspace.tab === "robot";
      if (store.state.sensorsShown !== isShown) store.dispatch({ type: "showSensors", shown: isShown });
    },
    render({ robots, selected, simulator, sensors }) {
      if (held !== null && held.name !== selected) keep(null);
      const robot = held?.robot ?? robots[selected];
      waiting.hidden = !(simulator?.paused && robot !== undefined && Object.keys(robot.raw).length === 0);
      if (robot === undefined || (robot === shown?.robot && sensors === declared)) return;
      const early = LEAST_MS - (performance.now() - shownMs);
      if (early > 0) {
        if (!isLate) setTimeout(() => scene.invalidate(), early);
        isLate = true;
        return;
      }
      isLate = false;
      shown = { name: selected, robot };
      declared = sensors;
      shownMs = performance.now();
      const values = pictureOf(robot);
      picture.show(values);
      stats.show(values);
      table.show(robot, sensors);
    },
  };
}
