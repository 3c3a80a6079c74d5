// Draws all robots with instancing: each piece of the model is one draw call, whatever the number of robots. Near
// robots and small ones on the screen are two separate sets. To add a piece, extend the lists below.

import * as THREE from "three";

import { createBody, createFarBody } from "./body.js";
import { createGroundPatches } from "./ground_patches.js";
import { createGroundGlow, createHalos } from "./halos.js";
import { createRays } from "./rays.js";
import { createScan } from "./scan.js";
import { createShadow } from "./shadow.js";
import { createWheels } from "./wheels.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/** @typedef {Pick<import("./instances.js").Instances, "place" | "show" | "dispose"> & { mesh: THREE.Object3D }} Part */
/**
 * @typedef {object} Look
 * @property {Robot} robot
 * @property {string | null} hovered  button under the pointer
 * @property {boolean} sensing        whether beams and patches are shown
 * @property {number} flash           0…1, of the whole body
 */
/** @typedef {{ look: Look, frame: THREE.Matrix4 }} DrawnRobot   the appearance of a robot, and its frame */
/**
 * @typedef {object} Piece
 * @property {Part[]} parts
 * @property {(slot: number, look: Look, before: Look | null) => void} show  before: what was shown in this slot, null: nothing
 * @property {(slot: number, frame: THREE.Matrix4) => void} [follow]  called before it is placed at another frame
 * @property {boolean} [isGlow]      soft light, which slow machines leave out
 * @property {boolean} [isOnGround]  it stays flat on the ground, however the robot stands
 * @property {import("./lamps.js").Lamps} [lamps]
 * @property {() => void} [dispose]
 */

/** @typedef {{ robots: number, fine: boolean }} Capacity   maximum number of robots, and level of detail */

/** @typedef {(capacity: Capacity) => Piece} PieceFactory */
const FINE = /** @type {PieceFactory[]} */ ([
  createShadow,
  createGroundGlow,
  createBody,
  createWheels,
  createHalos,
  createScan,
  createRays,
  createGroundPatches,
]);
const COARSE = /** @type {PieceFactory[]} */ ([createShadow, createGroundGlow, createFarBody, createScan, createRays, createGroundPatches]);

export class RobotInstances {
  /** @param {{ fine: boolean }} how */
  constructor({ fine }) {
    this.fine = fine;
    this.group = new THREE.Group();
    this.capacity = 0;
    /** @type {Piece[]} */ this.pieces = [];
    /** @type {DrawnRobot[]} */ this.shown = [];
  }

  /** Show exactly these robots. @param {DrawnRobot[]} robots */
  update(robots) {
    if (robots.length > this.capacity) this.#grow(robots.length);
    robots.forEach(({ look, frame }, slot) => {
      const before = this.shown[slot] ?? null;
      const same = before !== null && isSame(before.look, look);
      if (same && before.frame.equals(frame)) return;
      const ground = onGround(frame);
      for (const { parts, show, follow, isOnGround } of this.pieces) {
        if (!same) show(slot, look, before?.look ?? null);
        follow?.(slot, frame);
        for (const part of parts) part.place(slot, isOnGround ? ground : frame);
      }
      this.shown[slot] = { look, frame: frame.clone() };
    });
    if (this.shown.length > robots.length) this.shown.length = robots.length;
    for (const { parts } of this.pieces) for (const part of parts) part.show(robots.length);
  }

  /** Whether soft light is drawn. @param {boolean} shown */
  setGlows(shown) {
    for (const { parts, isGlow } of this.pieces) {
      if (isGlow) for (const { mesh } of parts) mesh.layers[shown ? "enable" : "disable"](0);
    }
  }

  /** Allocate slots for twice the current number of robots. @param {number} robots */
  #grow(robots) {
    this.dispose();
    this.capacity = robots === 1 ? 1 : 2 * robots;
    const capacity = { robots: this.capacity, fine: this.fine };
    this.pieces = (this.fine ? FINE : COARSE).map((create) => create(capacity));
    for (const { parts } of this.pieces) this.group.add(...parts.map(({ mesh }) => mesh));
  }

  dispose() {
    for (const { parts, dispose } of this.pieces) {
      for (const part of parts) part.dispose();
      dispose?.();
    }
    this.group.clear();
    this.pieces = [];
    this.shown = [];
  }
}

/** @param {Look} one @param {Look} other */
function isSame(one, other) {
  return /** @type {(keyof Look)[]} */ (["robot", "hovered", "sensing", "flash"]).every((key) => one[key] === other[key]);
}

/** The frame of a robot that stands flat at the same place. @param {THREE.Matrix4} frame */
function onGround({ elements }) {
  const yaw = Math.atan2(elements[1], elements[0]);
  return new THREE.Matrix4().makeRotationZ(yaw).setPosition(elements[12], elements[13], 0);
}
