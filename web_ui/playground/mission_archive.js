// The archive of a mission: ZIP with the mission, its playground, programs and pictures. Pure.

import { strFromU8, strToU8, unzipSync, zipSync } from "fflate";

import { parse, write } from "./document.js";
import { withMission } from "./mission.js";
import { missionFile, missionOf, PLAYGROUND_FILE, programFile } from "./mission_content.js";
import { describe, Fault } from "./rules.js";

/** @typedef {import("./document.js").Playground} Playground */
/** @typedef {import("./mission.js").Goal} Goal */
/** @typedef {Record<string, Uint8Array>} Files   by name */

const MISSION_FILE = "mission.json";
/** All files of an archive may unpack to so many bytes, and may be so many. */
const MAX_BYTES = 20_000_000;
const MAX_FILES = 200;
/** Members that name files by language. */
const PROGRAMS = /** @type {const} */ (["programs", "solutions"]);

/**
 * The archive of a playground with a mission.
 *
 * @param {Playground} playground
 * @param {(goal: Goal) => string} textOf  the usual text of a goal
 */
export function pack(playground, textOf) {
  const { mission } = playground;
  const programs = PROGRAMS.flatMap((group) => Object.entries(mission?.[group] ?? {}).map(([language, text]) => [programFile(group, language), strToU8(text)]));
  const others = Object.entries(mission?.files ?? {}).map(([name, data]) => [name, Uint8Array.from(atob(data), (letter) => letter.charCodeAt(0))]);
  return zipSync({
    ...Object.fromEntries(others),
    [MISSION_FILE]: strToU8(`${JSON.stringify(missionFile(playground, textOf), null, 2)}\n`),
    [PLAYGROUND_FILE]: strToU8(write(playground)),
    ...Object.fromEntries(programs),
  });
}

/**
 * The playground with the mission of an archive. Throws a Fault with the place and the reason.
 *
 * @param {Uint8Array} bytes
 * @returns {Playground}
 */
export function unpack(bytes) {
  try {
    return unpacked(inFolder(unzipped(bytes)));
  } catch (error) {
    if (error instanceof RangeError) throw new Fault(MISSION_FILE, error.message, { word: "fault.tooMuch" }); // nested too deeply
    throw error;
  }
}

/** @param {Files} files @returns {Playground} */
function unpacked(files) {
  const mission = readObject(files, MISSION_FILE);
  check(mission);
  const { playground: place, title } = mission;
  const playgroundFile = typeof place === "string" ? place : PLAYGROUND_FILE;
  const playground = parse(readText(files, playgroundFile));
  /** @param {"programs" | "solutions"} group */
  const texts = (group) => Object.fromEntries(Object.entries(mission[group] ?? {}).map(([language, path]) => [language, readText(files, String(path))]));
  const found = missionOf(mission, playground, texts("programs"), texts("solutions"));
  const read = [MISSION_FILE, playgroundFile, ...PROGRAMS.flatMap((group) => Object.values(mission[group] ?? {}))];
  const others = Object.entries(files).filter(([name]) => !read.includes(name));
  const kept = Object.fromEntries(others.map(([name, data]) => [name, btoa(strFromU8(data, true))]));
  return withMission({ ...playground, title: typeof title === "string" ? title : playground.title }, { ...found, files: kept });
}

/** @param {Uint8Array} bytes @returns {Files} */
function unzipped(bytes) {
  let [size, count] = [0, 0];
  try {
    return unzipSync(bytes, {
      filter: ({ originalSize, name }) => {
        if (name.endsWith("/") || name.startsWith("__MACOSX")) return false;
        size += originalSize;
        count += 1;
        if (size > MAX_BYTES || count > MAX_FILES) throw new Fault(name, "–", { word: "fault.tooMuch" });
        return true;
      },
    });
  } catch (error) {
    if (error instanceof Fault) throw error;
    throw new Fault("", error instanceof Error ? error.message : String(error), { word: "fault.zip" });
  }
}

/** The files by their names beside the mission, which may be in a folder. @param {Files} files @returns {Files} */
function inFolder(files) {
  const place = Object.keys(files).find((name) => name.endsWith(`/${MISSION_FILE}`));
  if (Object.hasOwn(files, MISSION_FILE) || place === undefined) return files;
  const folder = place.slice(0, -MISSION_FILE.length);
  return Object.fromEntries(Object.entries(files).filter(([name]) => name.startsWith(folder)).map(([name, data]) => [name.slice(folder.length), data]));
}

/** @param {Files} files @param {string} name */
function readText(files, name) {
  if (!Object.hasOwn(files, name)) throw new Fault(name, "–", { word: "fault.file", values: { name } });
  return strFromU8(files[name]);
}

/** @param {Files} files @param {string} name @returns {Record<string, any>} */
function readObject(files, name) {
  /** @type {unknown} */ let data;
  try {
    data = JSON.parse(readText(files, name));
  } catch (error) {
    if (error instanceof Fault) throw error;
    throw new Fault(name, String(error), { word: "fault.json" });
  }
  checkObject({ [name]: data }, name);
  return /** @type {Record<string, any>} */ (data);
}

/** Throws a Fault for a member of which the form could make nothing. @param {Record<string, any>} mission */
function check(mission) {
  for (const key of ["facts", "zones", ...PROGRAMS]) checkObject(mission, key);
  for (const key of ["story", "robot"]) if (typeof (mission[key] ?? "") !== "string") throw new Fault(key, describe(mission[key]), { word: "fault.text" });
  for (const key of ["hints", "languages"]) {
    checkList(mission, key);
    for (const text of mission[key] ?? []) if (typeof text !== "string") throw new Fault(key, describe(text), { word: "fault.text" });
  }
  for (const key of ["stars", "happens"]) {
    checkList(mission, key);
    for (const one of mission[key] ?? []) checkObject({ [key]: one }, key);
  }
  for (const [name, fact] of Object.entries(mission.facts ?? {})) checkObject({ [name]: fact }, name);
}

/** Throws a Fault for a member that is there and no object. @param {Record<string, any>} data @param {string} key */
function checkObject(data, key) {
  const value = data[key];
  if (value !== undefined && (typeof value !== "object" || value === null || Array.isArray(value))) throw new Fault(key, describe(value), { word: "fault.object" });
}

/** Throws a Fault for a member that is there and no list. @param {Record<string, any>} data @param {string} key */
function checkList(data, key) {
  const value = data[key];
  if (value !== undefined && !Array.isArray(value)) throw new Fault(key, describe(value), { word: "fault.list" });
}
