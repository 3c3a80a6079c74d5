// What each robot of a class is doing, in one word. Pure.

import { numberOf } from "../scene/tags.js";
import { lineOf } from "../state/program_status.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../state/robot.js").Program} Program */
/** @typedef {"runs" | "stopped" | "halted" | "mistake" | "fell" | "idle"} ClassState */
/** @typedef {"all" | "look" | "idle"} Filter */
/** @typedef {{ robot: string, number: string, state: ClassState, line: number }} Member */

export const FILTERS = /** @type {readonly Filter[]} */ (["all", "look", "idle"]);

/** The program that waits until something is chosen: its robot has not been started. */
const WAITING = /^welcome(?:\.aesl)?$/;
const BY_STATE = /** @type {Readonly<Record<string, ClassState>>} */ ({
  running: "runs",
  stopped: "stopped",
  paused: "halted",
  fault: "mistake",
});
/** States of robots whose pupils need help. */
const NEEDS_LOOK = /** @type {ReadonlySet<ClassState>} */ (new Set(["mistake", "fell", "halted"]));

/** @param {Pick<Program, "state" | "name"> | undefined} program @param {boolean} hasFallen @returns {ClassState} */
export function classState(program, hasFallen) {
  if (hasFallen) return "fell";
  const state = BY_STATE[program?.state ?? ""] ?? "idle";
  return state === "runs" && WAITING.test(program?.name ?? "") ? "idle" : state;
}

/** @param {ClassState} state */
export function needsLook(state) {
  return NEEDS_LOOK.has(state);
}

/** @param {Pick<State, "robots" | "programs" | "simulator">} state @returns {Member[]} */
export function membersOf({ robots, programs, simulator }) {
  const names = Object.keys(robots);
  const fallen = new Set(simulator?.fallen ?? []);
  return names.map((robot, at) => {
    const program = programs[robot] ?? programs[""];
    const state = classState(program, fallen.has(robot));
    return { robot, number: numberOf(robot, at + 1), state, line: program === undefined ? 0 : lineOf(program.values) };
  });
}

/** @param {Filter} filter @param {Member} member */
export function fits(filter, { state }) {
  return filter === "all" || (filter === "look" ? needsLook(state) : state === "idle");
}

/** Since when robots need a look, as this page saw it. */
export class Troubles {
  constructor() {
    /** @type {Map<string, { state: ClassState, sinceMs: number }>} */ this.since = new Map();
  }

  /** @param {readonly Member[]} members @param {number} nowMs */
  update(members, nowMs) {
    const before = this.since;
    this.since = new Map(
      members
        .filter(({ state }) => needsLook(state))
        .map(({ robot, state }) => {
          const known = before.get(robot);
          return [robot, known?.state === state ? known : { state, sinceMs: nowMs }];
        }),
    );
  }

  /** Whole minutes for which a robot has needed a look. @param {string} robot @param {number} nowMs */
  minutes(robot, nowMs) {
    return Math.floor((nowMs - (this.since.get(robot)?.sinceMs ?? nowMs)) / 60_000);
  }

  /**
   * The robot to look at first: the selected one if it needs a look, else the one that has waited longest.
   *
   * @param {string} selected
   * @returns {string | null}
   */
  first(selected) {
    if (this.since.has(selected)) return selected;
    const [longest] = [...this.since].sort(([, one], [, other]) => one.sinceMs - other.sinceMs);
    return longest?.[0] ?? null;
  }
}
