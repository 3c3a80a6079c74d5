// One robot: its frame at its pose, what pointers hit in it, and where its parts are. `instances.js` draws it.

import * as THREE from "three";

import { createTargets } from "./buttons.js";
import { poseAt } from "./motion.js";
import { PARTS } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

export class RobotModel {
  /** @param {string} name */
  constructor(name) {
    this.name = name;
    this.group = new THREE.Group();
    this.targets = createTargets(name);
    this.group.add(...this.targets.meshes);
  }

  /**
   * Take over where the robot is; true while it is still on its way to its last pose.
   *
   * @param {Robot} robot
   * @param {number} nowMs
   */
  update(robot, nowMs) {
    this.group.visible = robot.latest !== null;
    if (robot.latest === null) return false;
    const { pose, arrived } = poseAt(robot.previous, robot.latest, nowMs);
    this.group.position.set(pose.x, pose.y, pose.z);
    this.group.rotation.set(pose.roll, pose.pitch, pose.yaw, "ZYX");
    this.group.updateMatrix();
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
    this.targets.dispose();
  }
}
