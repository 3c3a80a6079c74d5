// One shape of all robots in one draw call: up to `each` copies per robot, placed in the robot's frame. Hidden copies
// are not sent to the GPU: in software rendering a copy costs about 11 µs per frame, whatever its size.

import * as THREE from "three";

const scratch = new THREE.Matrix4();

export class Instances {
  /**
   * @param {THREE.BufferGeometry} geometry  owned by this object, like the material
   * @param {THREE.Material} material
   * @param {{ each: number, robots: number }} counts  copies per robot, maximum number of robots
   */
  constructor(geometry, material, { each, robots }) {
    this.each = each;
    this.mesh = new THREE.InstancedMesh(geometry, material, each * robots);
    this.mesh.frustumCulled = false;
    this.mesh.instanceMatrix.setUsage(THREE.DynamicDrawUsage);
    /** @type {(THREE.Matrix4 | null)[]} */ this.locals = new Array(each * robots).fill(null);
    this.places = new Float32Array(16 * each * robots);
    /** @type {Float32Array | null} */ this.colors = null;
    this.robots = 0;
    this.changed = true;
  }

  /**
   * Set the position of a copy in its robot's frame, effective at the next `place`; null hides it.
   *
   * @param {number} robot
   * @param {number} index
   * @param {THREE.Matrix4 | null} local
   */
  put(robot, index, local) {
    this.locals[robot * this.each + index] = local;
  }

  /** @param {number} robot @param {number} index @param {THREE.Color} color */
  tint(robot, index, color) {
    this.colors ??= new Float32Array(3 * this.locals.length);
    color.toArray(this.colors, 3 * (robot * this.each + index));
    this.changed = true;
  }

  /** @param {number} robot @param {THREE.Matrix4} world  the robot's frame in the world */
  place(robot, world) {
    for (let number = robot * this.each; number < (robot + 1) * this.each; number++) {
      const local = this.locals[number];
      if (local !== null) scratch.multiplyMatrices(world, local).toArray(this.places, 16 * number);
    }
    this.changed = true;
  }

  /** Draw the copies of the first robots. @param {number} robots */
  show(robots) {
    if (!this.changed && robots === this.robots) return;
    this.changed = false;
    this.robots = robots;
    if (this.colors !== null) this.mesh.instanceColor ??= attribute(this.locals.length, 3);
    const { instanceMatrix, instanceColor } = this.mesh;
    let drawn = 0;
    for (let number = 0; number < robots * this.each; number++) {
      if (this.locals[number] === null) continue;
      copy(this.places, number, instanceMatrix, drawn);
      if (this.colors !== null && instanceColor !== null) copy(this.colors, number, instanceColor, drawn);
      drawn += 1;
    }
    this.mesh.count = drawn;
    this.mesh.visible = drawn > 0;
    for (const sent of [instanceMatrix, instanceColor]) {
      if (sent === null || drawn === 0) continue;
      sent.clearUpdateRanges();
      sent.addUpdateRange(0, sent.itemSize * drawn);
      sent.needsUpdate = true;
    }
  }

  dispose() {
    this.mesh.geometry.dispose();
    /** @type {THREE.Material} */ (this.mesh.material).dispose();
    this.mesh.dispose();
  }
}

/** @param {number} count @param {number} size */
function attribute(count, size) {
  return new THREE.InstancedBufferAttribute(new Float32Array(count * size), size).setUsage(THREE.DynamicDrawUsage);
}

/** @param {Float32Array} from @param {number} number @param {THREE.InstancedBufferAttribute} to @param {number} index */
function copy(from, number, to, index) {
  const size = to.itemSize;
  to.array.set(from.subarray(size * number, size * (number + 1)), size * index);
}

/**
 * A position in the robot's frame, turned about one axis.
 *
 * @param {{ x: number, y: number, z: number }} place
 * @param {{ axis?: "X" | "Y" | "Z", angle?: number }} [turn]  radians
 */
export function placeOf({ x, y, z }, { axis = "Z", angle = 0 } = {}) {
  return new THREE.Matrix4()[`makeRotation${axis}`](angle).setPosition(x, y, z);
}
