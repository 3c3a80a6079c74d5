// A robot flashes once when it has got another program. Pure.

const LASTS_MS = 400;

/** @typedef {import("../state/index.js").State} State */

export class Flashes {
  constructor() {
    /** @type {Map<string, { program: string, beganMs: number }>} */ this.robots = new Map();
  }

  /**
   * Brightness of the flash, 0…1, and whether it goes on. The first program of a robot is not news.
   *
   * @param {State} state
   * @param {string} robot
   * @param {number} nowMs
   * @returns {number}
   */
  of({ programs }, robot, nowMs) {
    const program = programs[robot] ?? programs[""];
    const loaded = program?.state === "running" ? `${program.name} ${program.values.bytecode_used}` : null;
    const known = this.robots.get(robot);
    if (loaded === null) return 0;
    if (known === undefined || known.program !== loaded) {
      this.robots.set(robot, { program: loaded, beganMs: known === undefined ? -Infinity : nowMs });
      return known === undefined ? 0 : 1;
    }
    return Math.max(0, 1 - (nowMs - known.beganMs) / LASTS_MS) ** 1.5;
  }
}
