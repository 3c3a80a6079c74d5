// One shape of all robots in one draw call: `each` copies per robot, placed in the robot's own frame.

import * as THREE from "three";

const scratch = new THREE.Matrix4();

export class Instances {
  /**
   * @param {THREE.BufferGeometry} geometry  owned from now on, with the material
   * @param {THREE.Material} material
   * @param {{ each: number, robots: number }} counts  copies per robot, robots at most
   */
  constructor(geometry, material, { each, robots }) {
    this.each = each;
    this.mesh = new THREE.InstancedMesh(geometry, material, each * robots);
    this.mesh.frustumCulled = false;
    this.mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    /** @type {(THREE.Matrix4 | null)[]} */ this.locals = new Array(each * robots).fill(null);
  }

  /** Where a copy is in its robot's frame from the next `place` on; null: nowhere. @param {number} robot @param {number} index @param {THREE.Matrix4 | null} local */
  put(robot, index, local) {
    this.locals[robot * this.each + index] = local;
  }

  /** @param {number} robot @param {number} index @param {THREE.Color} colour */
  tint(robot, index, colour) {
    this.mesh.setColorAt(robot * this.each + index, colour);
    if (this.mesh.instanceColor !== null) this.mesh.instanceColor.needsUpdate = true;
  }

  /** @param {number} robot @param {THREE.Matrix4} world  the robot's frame in the world */
  place(robot, world) {
    const { array } = this.mesh.instanceMatrix;
    for (let number = robot * this.each; number < (robot + 1) * this.each; number++) {
      const local = this.locals[number];
      if (local === null) array.fill(0, 16 * number, 16 * number + 16);
      else scratch.multiplyMatrices(world, local).toArray(array, 16 * number);
    }
    this.mesh.instanceMatrix.needsUpdate = true;
  }

  /** Draw the copies of the first so many robots. @param {number} robots */
  show(robots) {
    this.mesh.count = robots * this.each;
    this.mesh.visible = robots > 0;
  }

  dispose() {
    this.mesh.geometry.dispose();
    /** @type {THREE.Material} */ (this.mesh.material).dispose();
    this.mesh.dispose();
  }
}

/**
 * A place in the robot's frame, turned about one axis.
 *
 * @param {{ x: number, y: number, z: number }} place
 * @param {{ axis?: "X" | "Y" | "Z", angle?: number }} [turn]  radians
 */
export function placeOf({ x, y, z }, { axis = "Z", angle = 0 } = {}) {
  return new THREE.Matrix4()[`makeRotation${axis}`](angle).setPosition(x, y, z);
}
