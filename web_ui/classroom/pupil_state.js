// What a pupil's robot is doing, in one word. Pure.

import { classState, needsLook } from "../class_tab/class_states.js";

/** @typedef {import("./api.js").Pupil} Pupil */
/** @typedef {import("../class_tab/class_states.js").ClassState | "paused" | "held" | "waiting" | "starting" | "broken"} PupilState */

/** Below this part of real time a machine counts as too slow. */
const SLOW = 0.9;

/** @param {Pupil} pupil @returns {PupilState} */
export function pupilState({ phase, fallen, programs, paused, held }) {
  if (phase !== "running") return phase;
  const states = programs.map(({ state, program }) => classState({ state, name: program }, false));
  if (fallen.length > 0) return "fell";
  return states.find(needsLook) ?? (paused ? (held ? "held" : "paused") : (states[0] ?? "idle"));
}

/** Whether the teacher should have a look: also at a robot that is stuck or does nothing in a mission, and at tries in vain. @param {Pupil} pupil */
export function needsHelp(pupil) {
  const state = pupilState(pupil);
  if (pupil.hand !== "" || pupil.trouble === "tries" || (pupil.trouble !== "" && state === "runs")) return true;
  return state === "broken" || (state !== "paused" && state !== "held" && state !== "waiting" && state !== "starting" && needsLook(state));
}

/** How fast a slow simulator is in percent of real time; null for one that keeps up. @param {Pupil} pupil */
export function slowPercent({ phase, paused, achieved }) {
  return phase === "running" && !paused && achieved > 0 && achieved < SLOW ? Math.round(100 * achieved) : null;
}
