// The camera: orbit, pan and zoom by mouse, touch and keys; four views; z is up.

import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";

import { fit } from "./fit.js";

/** @typedef {"home" | "top" | "follow" | "eye"} ViewName */
/** @typedef {{ top?: number, right?: number, bottom?: number, left?: number }} Insets  CSS pixels */

export const VIEWS = /** @type {readonly ViewName[]} */ (["home", "top", "follow", "eye"]);

const FOLLOW = { back: 0.42, up: 0.3 };
/** The robot's view: from its front, above the front sensors. */
const EYE = { ahead: 0.083, up: 0.045 };
const NEAREST_M = 0.02;
const NEAR_SHARE = 0.05;
const TURN_STEP = Math.PI / 24;
const ZOOM_STEP = 1.15;

export class Camera {
  /** @param {HTMLElement} element  element that gets pointer events @param {() => void} changed */
  constructor(element, changed) {
    this.camera = new THREE.PerspectiveCamera(42, 1, NEAREST_M, 30);
    this.camera.up.set(0, 0, 1);
    this.camera.position.set(-1, -0.8, 0.9);
    this.controls = new OrbitControls(this.camera, element);
    this.controls.maxPolarAngle = Math.PI / 2 - 0.03; // never below the ground
    this.controls.minDistance = 0.12;
    this.controls.maxDistance = 12;
    this.controls.addEventListener("change", changed);
    this.controls.addEventListener("start", () => (this.touched = true));
    this.changed = changed;
    /** @type {ViewName} */ this.view = "home";
    /** Whether the user has moved the camera since the view was chosen. */
    this.touched = false;
    /** @type {THREE.Vector3[]} corners that the overview shows */
    this.corners = [new THREE.Vector3(-0.5, -0.5, 0), new THREE.Vector3(0.5, 0.5, 0)];
    this.target = new THREE.Vector3();
    this.size = { width: 1, height: 1 };
    this.insets = { top: 0, right: 0, bottom: 0, left: 0 };
  }

  /** @param {number} width @param {number} height */
  resize(width, height) {
    this.size = { width, height };
    const { top, right, bottom, left } = this.insets;
    this.camera.aspect = width / height;
    if (top === bottom && left === right) this.camera.clearViewOffset();
    else this.camera.setViewOffset(width, height, (right - left) / 2, (bottom - top) / 2, width, height);
    this.camera.updateProjectionMatrix();
    if (!this.touched && !this.goesAlong) this.setView(this.view);
  }

  /** Space at the edges that is covered: worlds are fitted into the rest. @param {Insets} insets */
  setInsets(insets) {
    this.insets = { top: 0, right: 0, bottom: 0, left: 0, ...insets };
    this.resize(this.size.width, this.size.height);
  }

  /** Nothing is nearer than this share of the way to what is looked at; near and far need a small ratio. */
  #setNear() {
    const far = this.camera.position.distanceTo(this.controls.target);
    const near = this.view === "eye" ? NEAREST_M : Math.max(NEAREST_M, NEAR_SHARE * far);
    if (Math.abs(near - this.camera.near) < 0.1 * near) return;
    this.camera.near = near;
    this.camera.updateProjectionMatrix();
  }

  /** The size of one CSS pixel near what is looked at, in meters. */
  get pixelSize() {
    return 1 / this.pixelsOf(1, this.controls.target);
  }

  /** How many CSS pixels a length takes there. @param {number} meters @param {THREE.Vector3} place */
  pixelsOf(meters, place) {
    const high = 2 * this.camera.position.distanceTo(place) * Math.tan((this.camera.fov * Math.PI) / 360);
    return (meters / high) * this.size.height;
  }

  /** Prepare for drawing. */
  ready() {
    this.#setNear();
    return this.camera;
  }

  /** Whether the view follows a robot. */
  get goesAlong() {
    return this.view === "follow" || this.view === "eye";
  }

  /**
   * Set the bounds of a new world.
   *
   * @param {THREE.Vector3[]} corners
   * @param {boolean} [held]  whether the camera stays where it is
   */
  frame(corners, held = false) {
    if (corners.length === 0) return;
    this.corners = corners;
    if (!held && !this.goesAlong) this.setView(this.view);
  }

  /**
   * Choose a view and move to its start position.
   *
   * @param {ViewName} view
   * @param {{ x: number, y: number, yaw: number } | null} [robot]
   */
  setView(view, robot = null) {
    this.view = view;
    this.touched = false;
    this.controls.enabled = view !== "eye";
    if (view === "eye") {
      this.follow(robot ?? { x: 0, y: 0, yaw: 0 });
      this.changed();
      return;
    }
    if (view === "follow") {
      const { x, y, yaw } = robot ?? { x: 0, y: 0, yaw: 0 };
      this.target.set(x, y, 0.03);
      this.#place(
        this.target,
        new THREE.Vector3(x - FOLLOW.back * Math.cos(yaw), y - FOLLOW.back * Math.sin(yaw), FOLLOW.up),
      );
      return;
    }
    // Straight from above, "up" is undefined; a tiny offset makes x point to the right.
    const from = (view === "top" ? new THREE.Vector3(0, -0.001, 1) : new THREE.Vector3(-0.22, -0.85, 0.85)).normalize();
    const { width, height } = this.size;
    const { top, right, bottom, left } = this.insets;
    const free = { width: Math.max(0.2 * height, width - left - right), height: Math.max(0.2 * height, height - top - bottom) };
    const slope = Math.tan((this.camera.fov * Math.PI) / 360) * (free.height / height);
    const shown = { fov: (360 / Math.PI) * Math.atan(slope), aspect: free.width / free.height };
    const { target, distance } = fit(shown, this.corners, from);
    this.#place(target, from.multiplyScalar(distance).add(target));
  }

  /**
   * Follow the robot: in the view "follow" the user may still orbit, in "eye" the camera has the robot's heading.
   *
   * @param {{ x: number, y: number, yaw: number }} robot
   */
  follow({ x, y, yaw }) {
    if (this.view === "eye") {
      const [ahead, left] = [Math.cos(yaw), Math.sin(yaw)];
      this.camera.position.set(x + EYE.ahead * ahead, y + EYE.ahead * left, EYE.up);
      this.camera.lookAt(x + 2 * ahead, y + 2 * left, EYE.up);
      this.camera.updateMatrixWorld();
      return;
    }
    if (this.view !== "follow") return;
    const moved = new THREE.Vector3(x - this.target.x, y - this.target.y, 0);
    if (moved.lengthSq() === 0) return;
    this.target.add(moved);
    this.controls.target.add(moved);
    this.camera.position.add(moved);
    this.controls.update();
  }

  /** Turn about the target. @param {number} sideways steps @param {number} upwards steps */
  turn(sideways, upwards) {
    if (this.view === "eye") return;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const sphere = new THREE.Spherical().setFromVector3(
      offset.clone().applyAxisAngle(new THREE.Vector3(1, 0, 0), -Math.PI / 2),
    );
    sphere.theta += sideways * TURN_STEP;
    sphere.phi = Math.min(this.controls.maxPolarAngle, Math.max(0.001, sphere.phi - upwards * TURN_STEP));
    offset.setFromSpherical(sphere).applyAxisAngle(new THREE.Vector3(1, 0, 0), Math.PI / 2);
    this.#moveTo(offset);
  }

  /** @param {number} steps  positive: closer */
  zoom(steps) {
    if (this.view === "eye") return;
    const offset = this.camera.position.clone().sub(this.controls.target);
    const length = offset.length() * ZOOM_STEP ** -steps;
    this.#moveTo(offset.setLength(Math.min(this.controls.maxDistance, Math.max(this.controls.minDistance, length))));
  }

  /** @param {THREE.Vector3} offset */
  #moveTo(offset) {
    this.touched = true;
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.changed();
  }

  /** @param {THREE.Vector3} target @param {THREE.Vector3} position */
  #place(target, position) {
    this.controls.target.copy(target);
    this.camera.position.copy(position);
    this.controls.update();
    this.changed();
  }
}
