// The ghost of a dragged body: translucent, red if the position is occupied; with a ring for turning.

import * as THREE from "three";

import { RING } from "../move/drag_controller.js";
import { reach } from "../move/placed_bodies.js";

/** @typedef {import("../move/drag_controller.js").Dragged} Held */

const FREE = 0x4b43b8;
const TAKEN = 0xb3261e;
const OPACITY = 0.45;
const ABOVE_M = 0.004;

export class Ghost {
  constructor() {
    this.group = new THREE.Group();
    this.material = new THREE.MeshBasicMaterial({ transparent: true, opacity: OPACITY, depthWrite: false });
    this.line = new THREE.MeshBasicMaterial({ side: THREE.DoubleSide });
    /** @type {string | null} */ this.shown = null;
  }

  /** @param {Held | null} held @param {boolean} ring  whether the ring is shown */
  update(held, ring) {
    this.group.visible = held !== null;
    if (held === null) return;
    const { body, pose, blocker } = held;
    const key = `${body.name} ${ring} ${body.outline.length} ${reach(body)}`;
    if (key !== this.shown) {
      this.shown = key;
      this.#build(held, ring);
    }
    this.group.position.set(pose.x, pose.y, 0);
    this.group.rotation.z = pose.yaw;
    this.material.color.set(blocker === null ? FREE : TAKEN);
    this.line.color.set(blocker === null ? FREE : TAKEN);
  }

  /** @param {Held} held @param {boolean} ring */
  #build({ body }, ring) {
    this.dispose();
    for (const polygon of body.outline) {
      const shape = new THREE.Shape(polygon.map(([x, y]) => new THREE.Vector2(x, y)));
      const solid = new THREE.ExtrudeGeometry(shape, { depth: body.height + ABOVE_M, bevelEnabled: false });
      this.group.add(new THREE.Mesh(solid, this.material));
    }
    if (!ring) return;
    const radius = reach(body) + RING.beyond;
    const circle = new THREE.RingGeometry(radius - 0.003, radius + 0.003, 48).translate(0, 0, ABOVE_M);
    const knob = new THREE.CircleGeometry(RING.width / 2.4, 24).translate(radius, 0, ABOVE_M);
    this.group.add(new THREE.Mesh(circle, this.line), new THREE.Mesh(knob, this.line));
  }

  dispose() {
    for (const mesh of this.group.children) /** @type {THREE.Mesh} */ (mesh).geometry.dispose();
    this.group.clear();
  }
}
