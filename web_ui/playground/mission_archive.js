// The archive of a mission: ZIP with the mission, its playground and start programs. Pure.

import { strFromU8, strToU8, unzipSync, zipSync } from "fflate";

import { parse, write } from "./document.js";
import { FORMAT, HEAD, LANGUAGES, newMission, withMission, zoneOf } from "./mission.js";
import { describe, Fault } from "./rules.js";

/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./mission.js").Goal} Goal */
/** @typedef {import("./mission.js").Mission} Mission */
/** @typedef {import("./mission.js").Order} Order */

const MISSION_FILE = "mission.json";
const PLAYGROUND_FILE = "playground.json";
const ENDINGS = /** @type {Record<string, string>} */ ({ ros: "py" });
/** A file of an archive may unpack to so many bytes. */
const MAX_BYTES = 20_000_000;

/**
 * The archive of a playground with a mission.
 *
 * @param {Playground} playground
 * @param {(goal: Goal) => string} textOf  the usual text of a goal
 */
export function pack(playground, textOf) {
  const programs = Object.entries(playground.mission?.programs ?? {}).map(([language, text]) => [programFile(language), strToU8(text)]);
  return zipSync({
    [MISSION_FILE]: strToU8(`${JSON.stringify(missionFile(playground, textOf), null, 2)}\n`),
    [PLAYGROUND_FILE]: strToU8(write(playground)),
    ...Object.fromEntries(programs),
  });
}

/**
 * The playground with the mission of an archive. Throws a Fault with the place and the reason, also for a mission that
 * the form of the creator cannot have.
 *
 * @param {Uint8Array} bytes
 * @returns {Playground}
 */
export function unpack(bytes) {
  /** @type {Record<string, Uint8Array>} */ let files;
  try {
    files = unzipSync(bytes, { filter: ({ originalSize }) => originalSize <= MAX_BYTES });
  } catch (error) {
    throw new Fault("", error instanceof Error ? error.message : String(error), { word: "fault.zip" });
  }
  const mission = readObject(files, MISSION_FILE);
  const { playground: name, programs = {}, title } = mission;
  const playground = parse(readText(files, typeof name === "string" ? name : PLAYGROUND_FILE));
  const texts = Object.fromEntries(Object.entries(programs).map(([language, path]) => [language, readText(files, String(path))]));
  const found = missionOf(mission, playground, texts);
  if (found === null) throw new Fault(MISSION_FILE, describe(title), { word: "fault.form" });
  return withMission({ ...playground, title }, found);
}

/** @param {Record<string, Uint8Array>} files @param {string} name */
function readText(files, name) {
  if (!Object.hasOwn(files, name)) throw new Fault(name, "–", { word: "fault.file", values: { name } });
  return strFromU8(files[name]);
}

/** @param {Record<string, Uint8Array>} files @param {string} name @returns {Record<string, any>} */
function readObject(files, name) {
  /** @type {unknown} */ let data;
  try {
    data = JSON.parse(readText(files, name));
  } catch (error) {
    if (error instanceof Fault) throw error;
    throw new Fault(name, String(error), { word: "fault.json" });
  }
  if (typeof data !== "object" || data === null || Array.isArray(data)) throw new Fault(name, describe(data), { word: "fault.object" });
  return data;
}

/** The content of the mission's file. @param {Playground} playground @param {(goal: Goal) => string} textOf  the usual text of a goal */
export function missionFile(playground, textOf) {
  const { title, mission = newMission() } = playground;
  /** @type {Record<string, any>} */ const facts = {};
  /** @type {Record<string, any>} */ const zones = {};
  /** @param {string} stem @param {Goal} goal @param {number} index */
  const fact = (stem, goal, index) => {
    const name = `${stem}_${index + 1}`;
    const zone = zoneOf(playground, goal.values.zone);
    if (zone !== null) zones[goal.values.zone] = zone;
    const robot = goal.robot === "" ? {} : { robot: goal.robot };
    facts[name] = { kind: goal.kind, ...goal.values, ...robot, text: goal.text || textOf(goal) };
    return goal.hold_s > 0 ? { hold: name, for_s: goal.hold_s } : name;
  };
  const parts = mission.goals.map((goal, index) => fact("goal", goal, index));
  const broken = mission.never.map((goal, index) => fact("never", goal, index));
  const stars = [
    ...(mission.within_s === null ? [] : [{ within_s: mission.within_s }]),
    ...(mission.length === null ? [] : [{ length: mission.length }]),
  ];
  return {
    format: FORMAT,
    title,
    story: mission.story,
    playground: PLAYGROUND_FILE,
    languages: [...mission.languages],
    programs: Object.fromEntries(Object.keys(mission.programs).map((language) => [language, programFile(language)])),
    zones,
    facts,
    success: mission.order === "then" ? { then: parts } : { all: mission.order === "any" ? parts.map((once) => ({ once })) : parts },
    ...(broken.length > 0 ? { failure: broken.length === 1 ? broken[0] : { any: broken } } : {}),
    time_s: mission.time_s,
    stars,
    hints: [...mission.hints],
  };
}

/** The file of a start program. @param {string} language */
function programFile(language) {
  return `programs/${language}.${ENDINGS[language] ?? "aesl"}`;
}

/**
 * The mission of a file, for the form; null if the form cannot have what it says, such as other conditions.
 *
 * @param {Record<string, any>} file      content of a file that the simulator accepts
 * @param {Playground} playground         its playground
 * @param {Record<string, string>} programs  texts of its start programs by language
 * @returns {Mission | null}
 */
export function missionOf(file, playground, programs) {
  const { facts = {}, failure, stars = [] } = file;
  const { then, all = [file.success] } = file.success ?? {};
  const isOnce = all.every((/** @type {any} */ part) => part?.once !== undefined);
  const order = then !== undefined ? "then" : isOnce ? "any" : "same";
  /** @param {any} part @returns {Goal | null} */
  const goalOf = (part) => {
    const inner = order === "any" && part?.once !== undefined ? part.once : part;
    const name = typeof inner === "string" ? inner : inner?.hold;
    if (typeof name !== "string" || !Object.hasOwn(facts, name)) return null;
    const { kind, robot = "", text = "", ...values } = facts[name];
    return { kind, robot, text, hold_s: inner.for_s ?? 0, values };
  };
  const goals = (then ?? all).map(goalOf);
  const never = (failure === undefined ? [] : (failure.any ?? [failure])).map(goalOf);
  if ([...goals, ...never].includes(null)) return null;
  const mission = {
    story: file.story ?? "",
    languages: file.languages ?? LANGUAGES,
    order: /** @type {Order} */ (order),
    goals,
    never,
    time_s: file.time_s ?? HEAD.time_s.default,
    within_s: stars.find((/** @type {any} */ star) => star.within_s !== undefined)?.within_s ?? null,
    length: stars.find((/** @type {any} */ star) => star.length !== undefined)?.length ?? null,
    hints: file.hints ?? [],
    programs,
  };
  const again = missionFile({ ...playground, title: file.title, mission }, () => "");
  return isSame(meaning(again), meaning(file)) ? mission : null;
}

/**
 * What a file means: facts in the place of their names, without what is as if it were left out.
 *
 * @param {Record<string, any>} file
 */
function meaning({ $schema: _schema, playground: _playground, programs: _programs, facts = {}, zones = {}, ...rest }) {
  /** @param {any} value @returns {any} */
  const resolved = (value) => {
    if (typeof value === "string") return Object.hasOwn(facts, value) ? { ...facts[value], zone: zones[facts[value].zone] } : value;
    if (Array.isArray(value)) return value.map(resolved);
    if (typeof value !== "object" || value === null) return value;
    return Object.fromEntries(Object.entries(value).map(([key, member]) => [key, resolved(member)]));
  };
  const { success, failure, ...others } = rest;
  const usual = { story: "", languages: LANGUAGES, hints: [], stars: [], time_s: HEAD.time_s.default };
  const parts = success?.then === undefined && success?.all === undefined ? { all: [success] } : success;
  return { ...usual, ...others, success: resolved(parts), failure: resolved(failure?.any?.length === 1 ? failure.any[0] : failure) };
}

/** Whether two JSON values are equal, whatever the order of members. @param {any} one @param {any} other @returns {boolean} */
function isSame(one, other) {
  if (typeof one !== "object" || typeof other !== "object" || one === null || other === null) return one === other;
  const keys = Object.keys({ ...one, ...other });
  return Array.isArray(one) === Array.isArray(other) && keys.every((key) => isSame(one[key], other[key]));
}
