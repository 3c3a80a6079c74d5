// The lists of goals in the form of the mission: what is wanted, what must not happen, what gives a star.

import { choicesOf, FACT, FACTS, GOAL_LISTS, LIMITS, newGoal, robotsOf, starCount } from "../playground/mission.js";
import { h } from "../ui/dom.js";
import { choiceControl, control, numberControl } from "./fields.js";
import { defaultsOf, kindChoice, present, replaced, verb, without, wordedVerb, wordFor } from "./mission_parts.js";

/** @typedef {import("../playground/mission.js").Goal} Goal */
/** @typedef {import("../playground/mission.js").GoalList} GoalList */
/** @typedef {import("../playground/mission.js").Mission} Mission */
/** @typedef {import("./mission_parts.js").Part} Part */

/** How long a goal lasts, 0 for a moment. */
const HOLD = /** @type {import("../playground/declarations.js").DeclaredField} */ ({ type: "number", unit: "s", low: 0, high: LIMITS.hold_s });
/** The kind of a new goal, if the playground has what it needs. */
const FIRST = /** @type {Readonly<Record<GoalList, string>>} */ ({ goals: "inside", never: "touches", extra: "lights" });

/**
 * The usual text of a goal.
 *
 * @param {import("../i18n/index.js").Translate} t
 * @param {Goal} goal
 */
export function usualText(t, { kind, values }) {
  const all = Object.entries({ ...defaultsOf(kind), ...values });
  const filled = Object.fromEntries(all.map(([key, value]) => [key, wordFor(t, value)]));
  return t(`goal.${kind}.text`, filled);
}

/** A list with its title and a button for a further goal. @param {Part} part @param {Mission} mission @param {GoalList} list */
export function goalList(part, mission, list) {
  const { t } = part.setting.labels;
  const add = () => {
    const playground = part.playground();
    const isPossible = FIRST[list] !== "inside" || choicesOf("inside", "zone", playground)?.length !== 0;
    part.change({ [list]: [...mission[list], newGoal(isPossible ? FIRST[list] : "driven", playground)] });
  };
  const more = wordedVerb("add", t(`mission.add.${list}`), `add-${list}`, add);
  const count = GOAL_LISTS.reduce((sum, each) => sum + mission[each].length, 0);
  more.disabled = count >= LIMITS.facts || (list === "extra" && starCount(mission) >= LIMITS.stars);
  const rows = mission[list].map((_, index) => goalRow(part, mission[list], list, index));
  return h("section", {}, h("h3", {}, t(`mission.${list}`)), h("ol", { class: "goals" }, ...rows), more);
}

/** @param {Part} part @param {readonly Goal[]} goals @param {GoalList} list @param {number} index */
function goalRow(part, goals, list, index) {
  const { t } = part.setting.labels;
  const goal = goals[index];
  /** @param {readonly Goal[]} next */
  const put = (next) => part.change({ [list]: next });
  const kinds = Object.keys(FACTS);
  const choose = (/** @type {string} */ kind) => put(replaced(goals, index, newGoal(kind, part.playground())));
  const kind = kindChoice("kind", t("mission.what"), kinds, goal.kind, (name) => t(`goal.${name}`), choose);
  const raise = verb("caretUp", t("mission.raise"), "raise", () => put([...goals.slice(0, index - 1), goal, goals[index - 1], ...goals.slice(index + 1)]));
  raise.hidden = index === 0;
  const remove = verb("close", t("mission.removeGoal"), "remove", () => put(without(goals, index)));
  return h(
    "li",
    { class: "goal", "data-goal": `${list}[${index}]` },
    h("div", { class: "row" }, kind, raise, remove),
    h("div", { class: "fields" }, ...goalFields(part, goal, list, (values) => put(replaced(goals, index, { ...goal, ...values }))).map(({ element }) => element)),
  );
}

/**
 * The fields of a goal: those of its kind, and those that all have.
 *
 * @param {Part} part
 * @param {Goal} goal
 * @param {GoalList} list
 * @param {(values: Partial<Goal>) => import("./fields.js").Phrase | null} replace
 */
function goalFields(part, goal, list, replace) {
  const { setting } = part;
  const { t } = setting.labels;
  const playground = part.playground();
  const inner = { ...setting, commit: (/** @type {Record<string, any>} */ values) => replace({ values: { ...goal.values, ...values } }) };
  const outer = { ...setting, commit: replace };
  const own = Object.entries(FACTS[goal.kind]).flatMap(([key, field]) => {
    const choices = choicesOf(goal.kind, key, playground);
    return (choices === null ? control(inner, key, field) : choiceControl(inner, key, () => choices, (value) => wordFor(t, value))) ?? [];
  });
  const robots = robotsOf(playground);
  const robot = choiceControl(outer, "robot", () => ["", ...robots], (name) => name || t("mission.firstRobot"));
  /** A text with the one that is used without it. @param {string} key @param {string} usual */
  const text = (key, usual) => {
    const one = control(outer, key, FACT.text);
    one?.element.querySelector("input")?.setAttribute("placeholder", usual);
    return present(one);
  };
  const usual = usualText(t, goal);
  const shared = [
    ...(robots.length > 1 ? [robot] : []),
    numberControl(outer, "hold_s", HOLD),
    ...(list === "extra" ? present(control(outer, "once", { type: "flag" })) : []),
    ...text("text", usual),
    ...(list === "goals" ? text("missing", goal.text || usual) : []),
    ...(list === "extra" ? text("star", goal.text || usual) : []),
  ];
  for (const one of own) one.update({ ...defaultsOf(goal.kind), ...goal.values });
  for (const one of shared) one.update(goal);
  return [...own, ...shared];
}
