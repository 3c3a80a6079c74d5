// The open mission and its present try, as the simulator publishes them, and how the view draws them. Pure.

import { MARKER } from "./markers.js";

/** @typedef {import("./markers.js").Marker} Marker */
/** @typedef {Readonly<Record<string, string>>} Names */
/** @typedef {{ title: string, story: string, hints: readonly string[], facts: Names, missing: Names }} Texts */
/** @typedef {{ kind: string, x_m: number, y_m: number, size_x_m?: number, size_y_m?: number, radius_m?: number, yaw_rad?: number }} Zone */
/** @typedef {{ text: string, within_s: number | null, length: number | null }} Star   beyond that of the goal */
/**
 * @typedef {Texts & { name: string, robot: string, languages: readonly string[], time_s: number, next: string,
 *   stars: readonly Star[], zones: Readonly<Record<string, Zone>>,
 *   programs: Names, solutions: Names, toolbox: { hide: readonly string[], modes: readonly string[] | null },
 *   translations: Readonly<Record<string, Texts & { stars: readonly string[] }>> }} Mission
 */
/**
 * What the present try has reached: `done` has an entry for each line of `checklist`, whose facts it lists; `trace` is
 * the way in m, at the end; `measured` has value, goal and unit of facts that are quantities.
 *
 * @typedef {{ mission: string, tries: number, state: "waiting" | "running" | "passed" | "failed",
 *   reason: "" | "facts" | "time" | "hand", at_s: number, trouble: "" | "fallen" | "stuck" | "idle",
 *   checklist: readonly (readonly string[])[], done: readonly boolean[], stars: readonly boolean[],
 *   broken: readonly string[], missing: readonly string[],
 *   measured: Readonly<Record<string, readonly [number, number, string]>>, trace: readonly (readonly [number, number])[] }} Try
 */

/** Zones and trace lie over floor and paint, the trace over the zones. */
const ZONE_Z = 0.02;
const TRACE_Z = 0.03;
const RIM_M = 0.006;
const TRACE_M = 0.008;
const CORNERS = 48;
const ZONE = { r: 0.29, g: 0.26, b: 0.72 };
/** The way of a try that was passed, and of one that was not. */
const WAYS = { passed: { r: 0.11, g: 0.5, b: 0.29 }, failed: { r: 0.7, g: 0.15, b: 0.12 } };

/** A text of a mission in a language, else its own. @param {Mission} mission @param {string} language @param {"title" | "story"} key */
export function missionText(mission, language, key) {
  return mission.translations[language]?.[key] || mission[key];
}

/** The text of a fact in a language. @param {Mission} mission @param {string} language @param {string} fact */
export function factText(mission, language, fact) {
  return mission.translations[language]?.facts?.[fact] || mission.facts[fact] || fact;
}

/** What is said of a fact that was not reached. @param {Mission} mission @param {string} language @param {string} fact */
export function missingText(mission, language, fact) {
  const translated = mission.translations[language];
  return translated?.missing?.[fact] || translated?.facts?.[fact] || mission.missing[fact] || factText(mission, language, fact);
}

/** How far a fact is, such as "0.32 of 0.5 m"; "": it is no quantity. @param {Try | null} attempt @param {string} fact @param {string} language */
export function measuredText(attempt, fact, language) {
  const found = attempt?.measured?.[fact];
  if (found === undefined) return "";
  const [value, goal, unit] = found;
  const digits = Number.isInteger(goal) && Math.abs(goal) >= 10 ? 0 : 2;
  /** @param {number} number */
  const shown = (number) => number.toLocaleString(language, { maximumFractionDigits: digits });
  return `${shown(value)} / ${shown(goal)}${unit === "" || unit === "°" ? unit : ` ${unit}`}`;
}

/** The hints in a language; those that are not translated are in the mission's own. @param {Mission} mission @param {string} language */
export function hintsOf(mission, language) {
  const translated = mission.translations[language]?.hints ?? [];
  return mission.hints.map((hint, at) => translated[at] || hint);
}

/**
 * Markers of the zones, and of the way when a try is over.
 *
 * @param {Mission | null} mission
 * @param {Try | null} attempt
 * @returns {ReadonlyMap<string, Marker>}
 */
export function missionMarkers(mission, attempt) {
  /** @type {Map<string, Marker>} */ const markers = new Map();
  if (mission === null) return markers;
  /** @param {Marker} marker */
  const add = (marker) => markers.set(`${marker.ns}/${marker.id}`, marker);
  for (const [name, zone] of Object.entries(mission.zones)) {
    const ring = outlineOf(zone);
    const fan = ring.slice(2).flatMap((third, at) => [ring[0], ring[at + 1], third]);
    add(marker(`paint/zone ${name}`, 0, MARKER.TRIANGLE_LIST, { ...ZONE, a: 0.16 }, ZONE_Z, 1, fan));
    add(marker(`paint/zone ${name}`, 1, MARKER.LINE_STRIP, { ...ZONE, a: 1 }, ZONE_Z, RIM_M, [...ring, ring[0]]));
  }
  const trace = attempt?.trace ?? [];
  if (trace.length > 1 && (attempt?.state === "passed" || attempt?.state === "failed")) {
    add(marker("paint/way", 0, MARKER.LINE_STRIP, { ...WAYS[attempt.state], a: 1 }, TRACE_Z, TRACE_M, thinned(trace)));
  }
  return markers;
}

/** The corners of a zone, counter-clockwise, in m. @param {Zone} zone @returns {(readonly [number, number])[]} */
function outlineOf({ kind, x_m: x, y_m: y, size_x_m: width = 0, size_y_m: height = 0, radius_m: radius = 0, yaw_rad: yaw = 0 }) {
  if (kind === "disc") {
    return Array.from({ length: CORNERS }, (_, at) => {
      const angle = (2 * Math.PI * at) / CORNERS;
      return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
    });
  }
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([along, across]) => {
    const [a, b] = [(along * width) / 2, (across * height) / 2];
    return [x + a * cos - b * sin, y + a * sin + b * cos];
  }); // prettier-ignore
}

/** A way without the places where the robot waited. @param {readonly (readonly [number, number])[]} way */
function thinned(way) {
  return way.filter(([x, y], at) => at === 0 || Math.hypot(x - way[at - 1][0], y - way[at - 1][1]) > 0.001);
}

/**
 * @param {string} ns
 * @param {number} id
 * @param {number} type
 * @param {import("./markers.js").Color} color
 * @param {number} z
 * @param {number} width
 * @param {readonly (readonly [number, number])[]} places
 * @returns {Marker}
 */
function marker(ns, id, type, color, z, width, places) {
  return {
    ns,
    id,
    type,
    action: 0,
    pose: { position: { x: 0, y: 0, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } },
    scale: { x: width, y: 1, z: 1 },
    color,
    points: places.map(([x, y]) => ({ x, y, z: 0 })),
    colors: [],
  };
}
