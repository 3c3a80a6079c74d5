// One robot: a group at its pose with all its parts. The list below is where a new part is added.

import * as THREE from "three";

import { createBlob } from "./blob.js";
import { createBody } from "./body.js";
import { createButtons } from "./buttons.js";
import { createGroundPatches } from "./ground_patches.js";
import { createLeds } from "./leds.js";
import { poseAt } from "./motion.js";
import { PARTS } from "./parts.js";
import { createRays } from "./rays.js";
import { createWheels } from "./wheels.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

export class RobotModel {
  /** @param {string} name */
  constructor(name) {
    this.name = name;
    this.group = new THREE.Group();
    const body = createBody();
    this.buttons = createButtons();
    this.sensing = [createRays(), createGroundPatches()];
    this.drawables = [createBlob(), createWheels(), createLeds(body.top), ...this.sensing];
    this.group.add(body.group, this.buttons.group, ...this.drawables.map(({ group }) => group));
    for (const target of this.buttons.targets) target.userData.robot = name;
    this.disposables = [body, this.buttons, ...this.drawables];
    /** @type {Robot | null} */ this.shown = null;
    /** @type {string | null} */ this.hovered = null;
  }

  /**
   * Take over the robot's state; true while it is still on its way to its last pose.
   *
   * @param {Robot} robot
   * @param {string | null} hovered  button under the pointer
   * @param {number} nowMs
   */
  update(robot, hovered, nowMs) {
    this.group.visible = robot.latest !== null;
    if (robot.latest === null) return false;
    if (robot !== this.shown) for (const drawable of this.drawables) drawable.update(robot);
    if (robot !== this.shown || hovered !== this.hovered) this.buttons.update(robot, hovered);
    this.shown = robot;
    this.hovered = hovered;
    const { pose, arrived } = poseAt(robot.previous, robot.latest, nowMs);
    this.group.position.set(pose.x, pose.y, pose.z);
    this.group.rotation.set(pose.roll, pose.pitch, pose.yaw, "ZYX");
    return !arrived;
  }

  /** Where a named part is in the world; null for an unknown name. @param {string} part */
  partPosition(part) {
    const place = PARTS.get(part);
    if (place === undefined) return null;
    this.group.updateMatrixWorld();
    return this.group.localToWorld(new THREE.Vector3(place.x, place.y, place.z));
  }

  dispose() {
    for (const thing of this.disposables) thing.dispose();
  }
}
