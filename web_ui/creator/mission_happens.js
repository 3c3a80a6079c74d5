// What happens in a mission, and when: presses of buttons, claps, hands, objects that are moved.

import { ACTIONS, actionOf, happeningChoices, HAPPENING, LIMITS, newHappening, robotsOf } from "../playground/mission.js";
import { h } from "../ui/dom.js";
import { choiceControl, control, numberControl } from "./fields.js";
import { kindChoice, replaced, verb, without, wordedVerb, wordFor } from "./mission_parts.js";

/** @typedef {import("../playground/mission.js").Happening} Happening */
/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("./mission_parts.js").Part} Part */

/** Time from one happening to a new one after it, in s. */
const GAP_S = 1;

/** @param {Part} part @param {Mission} mission */
export function happeningList(part, mission) {
  const { t } = part.setting.labels;
  const { happens } = mission;
  const last = happens.reduce((latest, { at_s }) => Math.max(latest, at_s), 0);
  const next = Math.min(last + GAP_S, HAPPENING.at_s.high ?? Infinity);
  const more = wordedVerb("add", t("mission.add.happens"), "add-happens", () => part.change({ happens: [...happens, newHappening("press", next, part.playground())] }));
  more.disabled = happens.length >= LIMITS.happens;
  return h("section", {}, h("h3", {}, t("mission.happens")), h("ol", { class: "goals" }, ...happens.map((_, index) => row(part, happens, index))), more);
}

/** @param {Part} part @param {readonly Happening[]} happens @param {number} index */
function row(part, happens, index) {
  const { setting } = part;
  const { t } = setting.labels;
  const happening = happens[index];
  const playground = part.playground();
  const action = actionOf(happening);
  const put = (/** @type {Happening} */ next) => part.change({ happens: replaced(happens, index, next) });
  const choose = (/** @type {string} */ name) => put(newHappening(name, happening.at_s, playground));
  const kind = kindChoice("action", t("mission.what"), ACTIONS, action, (name) => t(`happening.${name}`), choose);
  const remove = verb("close", t("mission.removeGoal"), "remove", () => part.change({ happens: without(happens, index) }));
  const own = { ...setting, commit: (/** @type {Record<string, any>} */ values) => put({ ...happening, ...values }) };
  const choices = happeningChoices(action, playground);
  const robots = robotsOf(playground);
  const places = ["x_m", "y_m", "yaw_rad"].flatMap((key) => control(own, key, HAPPENING[key]) ?? []);
  const fields = [
    numberControl(own, "at_s", HAPPENING.at_s),
    ...(choices !== null ? [choiceControl(own, action, () => choices, (value) => wordFor(t, value))] : action === "clap" ? [numberControl(own, action, HAPPENING.clap)] : []),
    ...(action === "move" ? places : robots.length > 1 ? [choiceControl(own, "robot", () => ["", ...robots], (name) => name || t("mission.firstRobot"))] : []),
  ];
  for (const one of fields) one.update({ robot: "", yaw_rad: 0, ...happening });
  return h(
    "li",
    { class: "goal", "data-goal": `happens[${index}]` },
    h("div", { class: "row" }, kind, remove),
    h("div", { class: "fields" }, ...fields.map(({ element }) => element)),
  );
}
