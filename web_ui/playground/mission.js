// The mission of a playground as the creator edits it: goals from a list, hints and start programs. Pure.

import declared from "./mission_declarations.json" with { type: "json" };
import { join } from "./rules.js";
import { valuesOf } from "./parts.js";

/** @typedef {import("./declarations.js").DeclaredField} Field */
/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./parts.js").Item} Item */
/** @typedef {import("./rules.js").Phrase} Phrase */
/**
 * A fact that is wanted, that must not happen, or that gives a star. `name`: in the file, "" one that is made; `text`:
 * for the checklist, "" the usual one; `missing`: for pupils who have not got there, "" is `text`; `hold_s`: for so long,
 * 0 for a moment; `once`: at any time, not at the end; `star`: text of its star, "" is `text`.
 *
 * @typedef {Readonly<{ name: string, kind: string, robot: string, text: string, missing: string, hold_s: number,
 *   once: boolean, star: string, values: Readonly<Record<string, any>> }>} Goal
 */
/**
 * What is done in a mission, as its file has it: `at_s`, `robot` if it is another one, and a member of `ACTIONS`.
 *
 * @typedef {Readonly<Record<string, any>> & { at_s: number }} Happening
 */
/** The lists of goals. @typedef {"goals" | "never" | "extra"} GoalList */
/** How goals belong together: each at any time, one after the other, or all in the same moment. @typedef {"any" | "then" | "same"} Order */
/**
 * What a playground has in addition if it is a mission. `within_s` and `length`: for a further star each, or null, with
 * their texts, "" the usual one; `extra`: for a further star each; `programs`, `solutions`: texts by language; `kept`: members
 * of the file in place of those that the form makes; `files`: what these name, in base64.
 *
 * @typedef {Readonly<{ story: string, robot: string, languages: readonly string[], order: Order, goals: readonly Goal[],
 *   never: readonly Goal[], extra: readonly Goal[], time_s: number, within_s: number | null, within_text: string,
 *   length: number | null, length_text: string, happens: readonly Happening[], hints: readonly string[],
 *   programs: Readonly<Record<string, string>>, solutions: Readonly<Record<string, string>>,
 *   kept: Readonly<Record<string, any>>, files: Readonly<Record<string, string>> }>} Mission
 */

const DECLARED = /** @type {{ format: number, languages: string[], limits: Record<string, number>,
 *   head: Record<string, Field>, star: Record<string, Field>, fact: Record<string, Field>,
 *   happening: Record<string, Field>, words: string[], facts: Record<string, Record<string, Field>> }} */ (
  /** @type {unknown} */ (declared)
);
/** Kinds of facts with their fields. */
export const FACTS = DECLARED.facts;
export const { format: FORMAT, limits: LIMITS, languages: LANGUAGES, head: HEAD, star: STAR, fact: FACT, happening: HAPPENING, words: WORDS } = DECLARED;
/** What can happen: members of a happening, of which each has one. */
export const ACTIONS = ["press", "release", "tap", "clap", "hand", "move"];
/** @type {readonly GoalList[]} */
export const GOAL_LISTS = ["goals", "never", "extra"];

/** A new mission. @returns {Mission} */
export function newMission() {
  return {
    story: "",
    robot: "",
    languages: LANGUAGES.filter((language) => language !== "ros"),
    order: "any",
    goals: [],
    never: [],
    extra: [],
    time_s: HEAD.time_s.default,
    within_s: null,
    within_text: "",
    length: null,
    length_text: "",
    happens: [],
    hints: [],
    programs: {},
    solutions: {},
    kept: {},
    files: {},
  };
}

/**
 * A new goal, with values as far as they are known. A name is the first possible one.
 *
 * @param {string} kind
 * @param {Playground} playground
 * @returns {Goal}
 */
export function newGoal(kind, playground) {
  const values = Object.fromEntries(
    Object.entries(FACTS[kind])
      .filter(([, field]) => field.required)
      .map(([key, field]) => [key, choicesOf(kind, key, playground)?.[0] ?? sampleOf(field)]),
  );
  return { ...goalOfKind(kind), values };
}

/** A goal without values. @param {string} kind @returns {Goal} */
export function goalOfKind(kind) {
  return { name: "", kind, robot: "", text: "", missing: "", hold_s: 0, once: false, star: "", values: {} };
}

/**
 * Something new that happens, with the first possible value.
 *
 * @param {string} action
 * @param {number} at_s
 * @param {Playground} playground
 * @returns {Happening}
 */
export function newHappening(action, at_s, playground) {
  const value = action === "tap" ? true : (happeningChoices(action, playground)?.[0] ?? (action === "clap" ? HAPPENING.clap.high : ""));
  return { at_s, [action]: value, ...(action === "move" ? { x_m: 0, y_m: 0 } : {}) };
}

/** The values of an action that has a list of them; null: it has none. @param {string} action @param {Playground} playground */
export function happeningChoices(action, { items }) {
  if (action === "move") return items.filter((item) => (valuesOf(item).mass_kg ?? null) !== null).map(({ name }) => name);
  return HAPPENING[action].pattern?.split("|") ?? null;
}

/** What happens. @param {Happening} happening */
export function actionOf(happening) {
  return ACTIONS.find((action) => (happening[action] ?? false) !== false) ?? "tap";
}

/**
 * The values of a field that has a list of them: names in the playground, or words. Null: it has none.
 *
 * @param {string} kind
 * @param {string} key
 * @param {Playground} playground
 * @returns {string[] | null}
 */
export function choicesOf(kind, key, { items, mission }) {
  const field = FACTS[kind][key];
  const optional = field.required ? [] : [""];
  if (key === "zone") {
    const areas = items.filter(hasArea).map(({ name }) => name).reverse(); // the ground is the last one
    return [...new Set([...areas, ...Object.keys(mission?.kept.zones ?? {})])];
  }
  if (key === "what") return [...optional, ...items.filter((item) => !hasArea(item) && item.kind !== "track").map(({ name }) => name)];
  if (key === "track") return [...optional, ...items.filter((item) => item.kind === "track").map(({ name }) => name)];
  if (key === "robot") return items.filter((item) => item.kind === "robot").map(({ name }) => name);
  const words = field.pattern?.split("|") ?? [];
  return words.length > 1 && words.every((word) => /^\w*$/.test(word)) ? words : null;
}

/** Whether an item lies flat on the floor, as an area that a robot can reach. @param {Item} item */
function hasArea(item) {
  return item.kind === "rectangle" || item.kind === "picture";
}

/** The zone that an item is: its area; null if it has none. @param {Playground} playground @param {string | undefined} name */
export function zoneOf({ items }, name) {
  const item = items.find((one) => one.name === name);
  if (item === undefined || !hasArea(item)) return null;
  const { x_m = 0, y_m = 0, size_x_m, size_y_m, yaw_rad = 0 } = valuesOf(item);
  return { kind: "rectangle", x_m, y_m, size_x_m, size_y_m, ...(yaw_rad === 0 ? {} : { yaw_rad }) };
}

/** @param {Field} field */
function sampleOf({ type, low = 0, high = 0 }) {
  if (type === "number") return low < 0 ? 0 : Math.min(high, Math.max(low, 0.1));
  return type === "flag" ? false : "";
}

/**
 * What is missing before the mission can be tried: the field and a phrase for each.
 *
 * @param {Playground} playground
 * @returns {{ key: string, phrase: Phrase }[]}
 */
export function problemsOf(playground) {
  const { mission } = playground;
  if (mission === undefined) return [];
  /** @type {{ key: string, phrase: Phrase }[]} */ const problems = [];
  if (!playground.items.some(({ kind }) => kind === "robot")) problems.push({ key: "robots", phrase: { word: "mission.noRobot" } });
  if (mission.goals.length === 0 && mission.kept.success === undefined) problems.push({ key: "goals", phrase: { word: "mission.noGoal" } });
  if (mission.languages.length === 0) problems.push({ key: "languages", phrase: { word: "mission.noLanguage" } });
  if (starCount(mission) > LIMITS.stars) problems.push({ key: "stars", phrase: { word: "mission.manyStars", values: { count: LIMITS.stars } } });
  mission.happens.forEach((happening, index) => {
    const action = actionOf(happening);
    const names = action === "move" ? happeningChoices(action, playground) : happening.robot ? robotsOf(playground) : null;
    const name = action === "move" ? happening.move : happening.robot;
    if (names !== null && !names.includes(name)) {
      problems.push({ key: `happens[${index}]`, phrase: { word: name ? "mission.unknownName" : "mission.noName", values: { name } } });
    }
  });
  for (const list of GOAL_LISTS) {
    mission[list].forEach(({ kind, robot, values }, index) => {
      const key = `${list}[${index}]`;
      for (const [name, value] of [...Object.entries(values), ...(robot === "" ? [] : [["robot", robot]])]) {
        const choices = name === "robot" ? robotsOf(playground) : choicesOf(kind, name, playground);
        if (choices !== null && !choices.includes(value)) {
          problems.push({ key: join(key, name), phrase: { word: value ? "mission.unknownName" : "mission.noName", values: { name: value } } });
        } else if (value === "" && FACTS[kind][name]?.required) {
          problems.push({ key: join(key, name), phrase: { word: "mission.noName" } });
        }
      }
    });
  }
  return problems;
}

/** Stars beyond that of the goal. @param {Mission} mission */
export function starCount({ within_s, length, extra }) {
  return extra.length + (within_s === null ? 0 : 1) + (length === null ? 0 : 1);
}

/** The names of the robots. @param {Playground} playground */
export function robotsOf({ items }) {
  return items.filter(({ kind }) => kind === "robot").map(({ name }) => name);
}

/**
 * The playground with changed values of its mission; without any, no longer a mission.
 *
 * @param {Playground} playground
 * @param {Partial<Mission> | null} values
 * @returns {Playground}
 */
export function withMission(playground, values) {
  const { mission, ...rest } = playground;
  return values === null ? rest : { ...rest, mission: { ...(mission ?? newMission()), ...values } };
}
