// One robot: its frame at its pose, its hit targets, and the positions of its parts. `robot_instances.js` draws it.

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
   * Update the pose; returns whether the interpolation is still in progress.
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

  /** The position of a named part in the world; null for an unknown name. @param {string} part */
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
