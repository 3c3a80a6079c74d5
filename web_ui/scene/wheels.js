// Two wheels that turn with the joint states; spokes make the turning visible.

import * as THREE from "three";

import { WHEEL } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

export function createWheels() {
  const tyre = new THREE.CylinderGeometry(WHEEL.radius, WHEEL.radius, WHEEL.width, 28);
  const hub = new THREE.CylinderGeometry(0.0135, 0.0135, WHEEL.width + 0.0012, 20);
  const spoke = new THREE.BoxGeometry(0.003, WHEEL.width + 0.0024, 0.024);
  const materials = {
    tyre: new THREE.MeshLambertMaterial({ color: 0x343b44 }),
    hub: new THREE.MeshLambertMaterial({ color: 0xd5dbe2 }),
    spoke: new THREE.MeshLambertMaterial({ color: 0x6b7684 }),
  };
  const group = new THREE.Group();
  const [left, right] = [1, -1].map((side) => {
    const wheel = new THREE.Group();
    const cross = new THREE.Mesh(spoke, materials.spoke);
    const other = new THREE.Mesh(spoke, materials.spoke);
    other.rotation.y = Math.PI / 2;
    wheel.add(new THREE.Mesh(tyre, materials.tyre), new THREE.Mesh(hub, materials.hub), cross, other);
    wheel.position.set(0, (side * WHEEL.track) / 2, WHEEL.radius);
    group.add(wheel);
    return wheel;
  });
  const owned = [tyre, hub, spoke, ...Object.values(materials)];
  return {
    group,
    /** @param {Robot} robot */
    update(robot) {
      left.rotation.y = robot.wheels.left;
      right.rotation.y = robot.wheels.right;
    },
    dispose: () => owned.forEach((thing) => thing.dispose()),
  };
}
