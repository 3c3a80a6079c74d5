// The content of a mission's file: what the form of the creator makes, and what it keeps of a file as it is. Pure.

import { actionOf, FACTS, FORMAT, goalOfKind, HEAD, LANGUAGES, newMission, zoneOf } from "./mission.js";

/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./mission.js").Goal} Goal */
/** @typedef {import("./mission.js").GoalList} GoalList */
/** @typedef {import("./mission.js").Mission} Mission */
/** @typedef {import("./mission.js").Order} Order */
/** @typedef {Record<string, any>} File   content of a mission's file */

/** Name of the playground in an archive. */
export const PLAYGROUND_FILE = "playground.json";
const STEMS = /** @type {Readonly<Record<GoalList, string>>} */ ({ goals: "goal", never: "never", extra: "star" });
const ENDINGS = /** @type {Record<string, string>} */ ({ ros: "py" });
/** Members that are those of the archive, or of its playground. */
const OWN = ["$schema", "format", "title", "playground", "programs", "solutions"];
/** Members that are as if they were left out. */
const USUAL = /** @type {File} */ ({ story: "", robot: "", languages: LANGUAGES, hints: [], stars: [], happens: [], time_s: HEAD.time_s.default });

/** The file of a program. @param {"programs" | "solutions"} group @param {string} language */
export function programFile(group, language) {
  return `${group}/${language}.${ENDINGS[language] ?? "aesl"}`;
}

/**
 * The content of a mission's file.
 *
 * @param {Playground} playground
 * @param {(goal: Goal) => string} textOf  the usual text of a goal
 * @returns {File}
 */
export function missionFile(playground, textOf) {
  const { title, mission = newMission() } = playground;
  /** @type {File} */ const facts = {};
  /** @type {File} */ const zones = {};
  /** The condition of a goal, whose fact and zone are noted. @param {GoalList} list @returns {(goal: Goal, index: number) => any} */
  const condition = (list) => (goal, index) => {
    const fact = factOf(goal, textOf);
    const name = nameOf(goal, facts, fact, `${STEMS[list]}_${index + 1}`, mission.kept.facts ?? {});
    facts[name] = fact;
    const zone = zoneOf(playground, goal.values.zone);
    if (zone !== null) zones[goal.values.zone] = zone;
    const held = goal.hold_s > 0 ? { hold: name, for_s: goal.hold_s } : name;
    return goal.once ? { once: held } : held;
  };
  const parts = mission.goals.map(condition("goals"));
  const broken = mission.never.map(condition("never"));
  const extra = mission.extra.map(condition("extra"));
  /** @param {string} text */
  const worded = (text) => (text === "" ? {} : { text });
  const stars = [
    ...(mission.within_s === null ? [] : [{ within_s: mission.within_s, ...worded(mission.within_text) }]),
    ...(mission.length === null ? [] : [{ length: mission.length, ...worded(mission.length_text) }]),
    ...mission.extra.map((goal, index) => ({ when: extra[index], ...worded(goal.star || goal.text || textOf(goal)) })),
  ];
  /** @param {"programs" | "solutions"} group */
  const files = (group) => Object.fromEntries(Object.keys(mission[group]).map((language) => [language, programFile(group, language)]));
  return {
    format: FORMAT,
    title,
    story: mission.story,
    playground: PLAYGROUND_FILE,
    ...(mission.robot === "" ? {} : { robot: mission.robot }),
    languages: [...mission.languages],
    programs: files("programs"),
    solutions: files("solutions"),
    success: mission.order === "then" ? { then: parts } : { all: mission.order === "any" ? parts.map((once) => ({ once })) : parts },
    ...(broken.length > 0 ? { failure: broken.length === 1 ? broken[0] : { any: broken } } : {}),
    time_s: mission.time_s,
    happens: [...mission.happens],
    stars,
    hints: [...mission.hints],
    ...mission.kept,
    zones: { ...zones, ...mission.kept.zones },
    facts: { ...facts, ...mission.kept.facts },
  };
}

/** @param {Goal} goal @param {(goal: Goal) => string} textOf */
function factOf(goal, textOf) {
  const { kind, values, robot, missing, text } = goal;
  return { kind, ...values, ...(robot === "" ? {} : { robot }), text: text || textOf(goal), ...(missing === "" ? {} : { missing }) };
}

/**
 * The name of a goal's fact: its own one, unless another fact has it by now.
 *
 * @param {Goal} goal
 * @param {File} facts     those before it
 * @param {object} fact
 * @param {string} usual
 * @param {File} kept      facts that are kept
 */
function nameOf({ name }, facts, fact, usual, kept) {
  const isFree = (/** @type {string} */ wanted) => !Object.hasOwn(facts, wanted) || isSame(facts[wanted], fact);
  if (name !== "" && isFree(name)) return name;
  let free = usual;
  for (let number = 2; !isFree(free) || Object.hasOwn(kept, free); number += 1) free = `${usual}_${number}`;
  return free;
}

/**
 * The mission of a file, for the form. What the form cannot have, such as other conditions, is kept as the file has it.
 *
 * @param {File} file      content of a file that the simulator accepts
 * @param {Playground} playground         its playground
 * @param {Record<string, string>} programs  texts of its start programs by language
 * @param {Record<string, string>} [solutions]
 * @returns {Mission}
 */
export function missionOf(file, playground, programs, solutions = {}) {
  const usual = newMission();
  const { success, failure, facts = {}, stars = [] } = file;
  const { then, all = [success] } = success ?? {};
  const isOnce = all.every((/** @type {any} */ part) => part?.once !== undefined);
  const order = /** @type {Order} */ (then !== undefined ? "then" : isOnce ? "any" : "same");
  const goals = (then ?? all).map((/** @type {any} */ part, /** @type {number} */ index) =>
    goalOf(order === "any" ? part.once : part, facts, `${STEMS.goals}_${index + 1}`),
  );
  const never = (failure === undefined ? [] : (failure?.any ?? [failure])).map((/** @type {any} */ part, /** @type {number} */ index) =>
    goalOf(part, facts, `${STEMS.never}_${index + 1}`),
  );
  const within = stars.find((/** @type {any} */ star) => star.within_s !== undefined);
  const length = stars.find((/** @type {any} */ star) => star.length !== undefined);
  const extra = stars
    .filter((/** @type {any} */ star) => star.when !== undefined)
    .map((/** @type {any} */ { when, text = "" }, /** @type {number} */ index) => starOf(when, text, facts, `${STEMS.extra}_${index + 1}`));
  /** @param {(Goal | null)[]} list @returns {Goal[]} */
  const ifAll = (list) => (list.includes(null) ? [] : /** @type {Goal[]} */ (list));
  const mission = {
    ...usual,
    story: file.story ?? usual.story,
    robot: file.robot ?? usual.robot,
    languages: file.languages ?? LANGUAGES,
    order: goals.includes(null) ? usual.order : order,
    goals: ifAll(goals),
    never: ifAll(never),
    extra: ifAll(extra),
    time_s: file.time_s ?? usual.time_s,
    within_s: within?.within_s ?? null,
    within_text: within?.text ?? "",
    length: length?.length ?? null,
    length_text: length?.text ?? "",
    happens: file.happens ?? [],
    hints: file.hints ?? [],
    programs,
    solutions,
  };
  return { ...mission, kept: leftOver(file, missionFile({ ...playground, title: file.title, mission }, () => "")) };
}

/** @param {any} part  of a condition @param {File} facts @param {string} usual  the name that the form would give @returns {Goal | null} */
function goalOf(part, facts, usual) {
  const name = typeof part === "string" ? part : part?.hold;
  if (typeof name !== "string" || !Object.hasOwn(facts, name)) return null;
  const { kind, robot = "", text = "", missing = "", ...values } = facts[name];
  if (!Object.hasOwn(FACTS, kind)) return null;
  return { ...goalOfKind(kind), name: name === usual ? "" : name, robot, text, missing, hold_s: part.for_s ?? 0, values };
}

/** The goal of a star. @param {any} when @param {string} text @param {File} facts @param {string} usual @returns {Goal | null} */
function starOf(when, text, facts, usual) {
  const goal = goalOf(when?.once ?? when, facts, usual);
  return goal && { ...goal, once: when.once !== undefined, star: text === goal.text ? "" : text };
}

/** What a file has and another one lacks. @param {File} file @param {File} made @returns {File} */
function leftOver(file, made) {
  const others = Object.keys(file).filter((key) => !OWN.includes(key) && key !== "facts" && key !== "zones");
  const kept = others.filter((key) => !isSame(meant(key, file[key]), meant(key, made[key] ?? USUAL[key])));
  /** @param {"facts" | "zones"} key @param {File} usual */
  const named = (key, usual) => {
    const own = Object.entries(file[key] ?? {}).filter(([name, value]) => !isSame({ ...usual, ...value }, { ...usual, ...made[key][name] }));
    return own.length === 0 ? {} : { [key]: Object.fromEntries(own) };
  };
  return {
    ...Object.fromEntries(kept.map((key) => [key, file[key]])),
    ...named("facts", { robot: "", text: "", missing: "" }),
    ...named("zones", { yaw_rad: 0 }),
  };
}

/** The value of a member in the one form of several that mean the same. @param {string} key @param {any} value */
function meant(key, value) {
  if (key === "success" && value?.then === undefined && value?.all === undefined) return { all: [value] };
  if (key === "failure" && value?.any?.length === 1) return value.any[0];
  if (key === "happens") return value.map((/** @type {any} */ each) => ({ robot: "", yaw_rad: 0, ...each, tap: actionOf(each) === "tap" }));
  if (key === "stars") return value.map((/** @type {any} */ each) => ({ text: "", ...each }));
  return value;
}

/** Whether two JSON values are equal, whatever the order of members. @param {any} one @param {any} other @returns {boolean} */
function isSame(one, other) {
  if (typeof one !== "object" || typeof other !== "object" || one === null || other === null) return one === other;
  const keys = Object.keys({ ...one, ...other });
  return Array.isArray(one) === Array.isArray(other) && keys.every((key) => isSame(one[key], other[key]));
}
