// Moves a robot or an object: selects it, shows it as a ghost while it is dragged, and places it. No DOM, no 3D scene.

import { atHeight, blocker, hit, movables, obstacles, reach } from "./placed_bodies.js";

/** @typedef {import("./placed_bodies.js").PlacedBody} PlacedBody */
/** @typedef {import("./placed_bodies.js").Pose} Pose */
/** @typedef {Parameters<typeof hit>[0]} Ray */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {{ body: PlacedBody, pose: Pose, blocker: string | null }} Dragged   blocker: name of the obstacle at the position of the ghost */

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
    /** @type {Dragged | null} */ this.dragged = null;
    /** @type {{ turning: boolean, z: number, dx: number, dy: number } | null} offset of the pointer during a drag */
    this.pointerOffset = null;
  }

  /** @param {boolean} on */
  setMode(on) {
    this.mode = on;
    this.cancel();
    if (on) this.#select(this.#bodyAt(0));
    this.changed();
  }

  /** Pointer down; returns whether a body was grabbed. @param {Ray} ray @param {boolean} wanted  by mode or Shift */
  grab(ray, wanted) {
    if (!wanted) return false;
    const floor = atHeight(ray, 0);
    if (this.mode && this.dragged !== null && floor !== null) {
      const { body, pose } = this.dragged;
      const away = Math.hypot(floor.x - pose.x, floor.y - pose.y) - reach(body) - RING.beyond;
      if (Math.abs(away) < RING.width / 2) {
        const dx = pose.yaw - Math.atan2(floor.y - pose.y, floor.x - pose.x);
        this.pointerOffset = { turning: true, z: 0, dx, dy: 0 };
        return true;
      }
    }
    const found = hit(ray, movables(this.state()));
    if (found === null) return false;
    this.#select(found.body);
    const { pose } = found.body;
    this.pointerOffset = { turning: false, z: found.z, dx: pose.x - found.x, dy: pose.y - found.y };
    return true;
  }

  /** Pointer move. @param {Ray} ray */
  drag(ray) {
    if (this.dragged === null || this.pointerOffset === null) return;
    const { turning, z, dx, dy } = this.pointerOffset;
    const point = atHeight(ray, z);
    if (point === null) return;
    const { pose } = this.dragged;
    if (turning) this.#moveGhost({ ...pose, yaw: Math.atan2(point.y - pose.y, point.x - pose.x) + dx });
    else this.#moveGhost({ ...pose, x: point.x + dx, y: point.y + dy });
  }

  /**
   * Move by keys, in steps: along x, along y, and turning counter-clockwise.
   *
   * @param {number} x
   * @param {number} y
   * @param {number} [turn]
   */
  nudge(x, y, turn = 0) {
    if (this.dragged === null) return;
    const { pose } = this.dragged;
    this.#moveGhost({ x: pose.x + x * STEP_M, y: pose.y + y * STEP_M, yaw: pose.yaw + turn * STEP_RAD });
    const { x: nowX, y: nowY, yaw } = this.dragged.pose;
    const values = { x: (nowX * 100).toFixed(0), y: (nowY * 100).toFixed(0), yaw: degrees(yaw) };
    if (this.dragged.blocker === null) this.report("move.at", values);
    else this.report("move.blocked", { ...values, by: this.dragged.blocker });
  }

  /** Select the next body. */
  next() {
    this.#select(this.#bodyAt(1));
    if (this.dragged !== null) this.report("move.selected", { name: this.dragged.body.name || "thymio" });
  }

  /** Place the body at the ghost; the simulator accepts or rejects the pose. */
  async drop() {
    const { dragged } = this;
    this.pointerOffset = null;
    if (dragged === null) return;
    const { body, pose } = dragged;
    await this.place(body.name, pose);
    if (this.dragged !== dragged) return;
    // In move mode the body stays selected at its new pose.
    this.dragged = null;
    if (this.mode) this.#follow(body.name);
    this.changed();
  }

  /** Cancel the drag; nothing has moved. */
  cancel() {
    this.dragged = null;
    this.pointerOffset = null;
    this.changed();
  }

  /** The state has changed: a ghost that is not being dragged follows its body. */
  refresh() {
    if (this.dragged === null || !this.mode || this.pointerOffset !== null) return;
    const { body, pose } = this.dragged;
    const { x, y, yaw } = body.pose;
    if (pose.x === x && pose.y === y && pose.yaw === yaw) this.#follow(body.name);
  }

  /** @param {string} name */
  #follow(name) {
    const body = movables(this.state()).find((one) => one.name === name);
    if (body === undefined) this.dragged = null;
    else this.dragged = { body, pose: body.pose, blocker: null };
  }

  /** @param {number} ahead  offset in the list of bodies, from the selected body or robot */
  #bodyAt(ahead) {
    const bodies = movables(this.state());
    const name = this.dragged?.body.name;
    const now = bodies.findIndex((one) =>
      name === undefined ? one.robot === this.state().selected : one.name === name,
    );
    return bodies[(Math.max(0, now) + ahead) % Math.max(1, bodies.length)];
  }

  /** @param {PlacedBody | undefined} body */
  #select(body) {
    this.dragged = body === undefined ? null : { body, pose: body.pose, blocker: null };
    this.changed();
  }

  /** @param {Pose} pose */
  #moveGhost(pose) {
    if (this.dragged === null) return;
    const { body } = this.dragged;
    const found = blocker(body, pose, obstacles(this.state(), body.name));
    this.dragged = { body, pose, blocker: found === null ? null : found.name };
    this.changed();
  }
}

/** @param {number} radians */
function degrees(radians) {
  return Math.round((radians * 180) / Math.PI) % 360;
}
