// Between points of the world, places in the view, and places in the window, which are in CSS pixels.

import * as THREE from "three";

/** @typedef {{ x: number, y: number }} Spot */

export class Projection {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("./drawing_size.js").DrawingSize} size   of the canvas
   * @param {() => THREE.Camera} eye
   */
  constructor(canvas, size, eye) {
    this.canvas = canvas;
    this.size = size;
    this.eye = eye;
  }

  /** From the world to the canvas; null behind the camera. @param {THREE.Vector3} place @returns {Spot | null} */
  toCanvas(place) {
    const { x, y, z } = place.clone().project(this.eye());
    if (z > 1 || z < -1) return null;
    const { width, height } = this.size.css;
    return { x: ((x + 1) / 2) * width, y: ((1 - y) / 2) * height };
  }

  /** From the world to the window. @param {number} x @param {number} y @param {number} z @returns {Spot | null} */
  toWindow(x, y, z) {
    const inside = this.toCanvas(new THREE.Vector3(x, y, z));
    const { left, top } = this.canvas.getBoundingClientRect();
    return inside === null ? null : { x: left + inside.x, y: top + inside.y };
  }

  /** The line of sight through a place of the window. @param {{ clientX: number, clientY: number }} event */
  rayOf({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(place, this.eye());
    return caster.ray;
  }
}
