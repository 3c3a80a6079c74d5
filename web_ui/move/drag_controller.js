// Moves a robot or an object: selects it, shows it as a ghost while it is dragged, and places it. No DOM, no 3D scene.

import { atHeight, blocker, hit, movables, obstacles, reach } from "./placed_bodies.js";

/** @typedef {import("./placed_bodies.js").PlacedBody} PlacedBody */
/** @typedef {import("./placed_bodies.js").Pose} Pose */
/** @typedef {Parameters<typeof hit>[0]} Ray */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {{ body: PlacedBody, pose: Pose, blocker: string | null }} Held   blocker: name of the obstacle at the position of the ghost */

/** The ring for turning: its distance from the outline, and the width that can be hit. */
export const RING = { beyond: 0.025, width: 0.03 };
const STEP_M = 0.01;
const STEP_RAD = Math.PI / 12;

export class DragController {
  /**
   * @param {object} options
   * @param {() => State} options.state
   * @param {(name: string, pose: Pose) => Promise<boolean>} options.place  asks the simulator; returns whether it accepted the pose
   * @param {() => void} options.changed
   * @param {(key: string, values: Record<string, string | number>) => void} options.report
   */
  constructor({ state, place, changed, report }) {
    this.state = state;
    this.place = place;
    this.changed = changed;
    this.report = report;
    /** Whether a drag on a body moves it without Shift. */
    this.mode = false;
    /** @type {Held | null} */ this.held = null;
    /** @type {{ turning: boolean, z: number, dx: number, dy: number } | null} offset of the pointer during a drag */
    this.grip = null;
  }

  /** @param {boolean} on */
  setMode(on) {
    this.mode = on;
    this.cancel();
    if (on) this.#hold(this.#choice(0));
    this.changed();
  }

  /** Pointer down; returns whether a body was grabbed. @param {Ray} ray @param {boolean} wanted  by mode or Shift */
  grab(ray, wanted) {
    if (!wanted) return false;
    const floor = atHeight(ray, 0);
    if (this.mode && this.held !== null && floor !== null) {
      const { body, pose } = this.held;
      const away = Math.hypot(floor.x - pose.x, floor.y - pose.y) - reach(body) - RING.beyond;
      if (Math.abs(away) < RING.width / 2) {
        const dx = pose.yaw - Math.atan2(floor.y - pose.y, floor.x - pose.x);
        this.grip = { turning: true, z: 0, dx, dy: 0 };
        return true;
      }
    }
    const found = hit(ray, movables(this.state()));
    if (found === null) return false;
    this.#hold(found.body);
    const { pose } = found.body;
    this.grip = { turning: false, z: found.z, dx: pose.x - found.x, dy: pose.y - found.y };
    return true;
  }

  /** Pointer move. @param {Ray} ray */
  drag(ray) {
    if (this.held === null || this.grip === null) return;
    const { turning, z, dx, dy } = this.grip;
    const place = atHeight(ray, z);
    if (place === null) return;
    const { pose } = this.held;
    if (turning) this.#carry({ ...pose, yaw: Math.atan2(place.y - pose.y, place.x - pose.x) + dx });
    else this.#carry({ ...pose, x: place.x + dx, y: place.y + dy });
  }

  /**
   * Move by keys, in steps: along x, along y, and turning counter-clockwise.
   *
   * @param {number} x
   * @param {number} y
   * @param {number} [turn]
   */
  nudge(x, y, turn = 0) {
    if (this.held === null) return;
    const { pose } = this.held;
    this.#carry({ x: pose.x + x * STEP_M, y: pose.y + y * STEP_M, yaw: pose.yaw + turn * STEP_RAD });
    const { x: nowX, y: nowY, yaw } = this.held.pose;
    const values = { x: (nowX * 100).toFixed(0), y: (nowY * 100).toFixed(0), yaw: degrees(yaw) };
    if (this.held.blocker === null) this.report("move.at", values);
    else this.report("move.blocked", { ...values, by: this.held.blocker });
  }

  /** Select the next body. */
  next() {
    this.#hold(this.#choice(1));
    if (this.held !== null) this.report("move.selected", { name: this.held.body.name || "thymio" });
  }

  /** Place the body at the ghost; the simulator accepts or rejects the pose. */
  async drop() {
    const { held } = this;
    this.grip = null;
    if (held === null) return;
    const { body, pose } = held;
    await this.place(body.name, pose);
    if (this.held !== held) return;
    // In move mode the body stays selected at its new pose.
    this.held = null;
    if (this.mode) this.#follow(body.name);
    this.changed();
  }

  /** Cancel the drag; nothing has moved. */
  cancel() {
    this.held = null;
    this.grip = null;
    this.changed();
  }

  /** The state has changed: a ghost that is not being dragged follows its body. */
  refresh() {
    if (this.held === null || !this.mode || this.grip !== null) return;
    const { body, pose } = this.held;
    const { x, y, yaw } = body.pose;
    if (pose.x === x && pose.y === y && pose.yaw === yaw) this.#follow(body.name);
  }

  /** @param {string} name */
  #follow(name) {
    const body = movables(this.state()).find((one) => one.name === name);
    if (body === undefined) this.held = null;
    else this.held = { body, pose: body.pose, blocker: null };
  }

  /** @param {number} ahead  offset in the list of bodies, from the selected body or robot */
  #choice(ahead) {
    const bodies = movables(this.state());
    const name = this.held?.body.name;
    const now = bodies.findIndex((one) =>
      name === undefined ? one.robot === this.state().selected : one.name === name,
    );
    return bodies[(Math.max(0, now) + ahead) % Math.max(1, bodies.length)];
  }

  /** @param {PlacedBody | undefined} body */
  #hold(body) {
    this.held = body === undefined ? null : { body, pose: body.pose, blocker: null };
    this.changed();
  }

  /** @param {Pose} pose */
  #carry(pose) {
    if (this.held === null) return;
    const { body } = this.held;
    const found = blocker(body, pose, obstacles(this.state(), body.name));
    this.held = { body, pose, blocker: found === null ? null : found.name };
    this.changed();
  }
}

/** @param {number} radians */
function degrees(radians) {
  return Math.round((radians * 180) / Math.PI) % 360;
}
