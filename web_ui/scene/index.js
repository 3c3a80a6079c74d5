// The 3D view: draws the state when something changed, in one animation loop. It makes no decisions.

import * as THREE from "three";

import { watchDrags } from "../move/drag.js";
import { isSensed } from "../state/names.js";
import { robotColor } from "../state/robot_colors.js";
import { Camera } from "./camera.js";
import { lightAs } from "./lights.js";
import { FrameLoop } from "./loop.js";
import { Painter } from "./painter.js";
import { Photographer } from "./photographer.js";
import { watchPointer } from "./pointer.js";
import { Projection } from "./projection.js";
import { pictureRatio, Quality } from "./quality.js";
import { ValueLabels, valueLabelsOf } from "./value_labels.js";
import { World } from "./world.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("./camera.js").ViewName} ViewName */
/** @typedef {import("./pointer.js").Target} Target */

/** Distance of a name above its robot in the 2D view. */
const FLAT_LABEL_PX = 24;
/** Robots smaller than this on the screen, in drawn pixels, use the coarse model. */
const SMALL_PX = 60;
const SIZE_M = 0.11;

export class SceneView {
  /**
   * @param {object} options
   * @param {HTMLCanvasElement} options.canvas
   * @param {HTMLCanvasElement} options.flatCanvas  canvas over it, for the 2D view
   * @param {HTMLElement} options.labels       layer for the robots' names
   * @param {() => State} options.state
   * @param {(nowMs: number) => void} options.beforeDraw   updates the panels in the same frame
   * @param {(target: Target, pressed: boolean) => void} options.press
   * @param {import("../move/drag_controller.js").DragController} options.dragController   the dragged body
   * @param {(name: string) => string} options.robotTitle
   * @param {(robot: string) => void} [options.select]   a robot's dot has been clicked
   * @param {() => import("../creator/sketch.js").Sketch | null} options.sketch   overlay of the creator; null while it is closed
   * @param {(trouble: "lost" | "gone" | null) => void} options.contextLost   gone: permanently, drawn in 2D
   * @param {() => import("./camera.js").Insets} [options.flatInsets]   what covers the 2D view besides, at its edges
   */
  constructor({ canvas, flatCanvas, labels, state, beforeDraw, press, dragController, robotTitle, select = () => {}, sketch, contextLost, flatInsets = () => ({}) }) {
    this.canvas = canvas;
    this.state = state;
    this.beforeDraw = beforeDraw;
    this.dragController = dragController;
    this.sketch = sketch;
    this.framed = false;
    this.frames = 0;
    this.showSensors = true;
    this.showNumbers = false;
    this.isCalm = false;
    this.flatInsets = flatInsets;
    this.painter = new Painter({ canvas, flatCanvas, changed: () => this.invalidate(), contextLost });
    this.quality = new Quality({ isSoftware: this.painter.isSoftware });
    this.loop = new FrameLoop({ quality: this.quality, draw: (nowMs) => this.#frame(nowMs) });
    this.valueLabels = new ValueLabels(labels);
    /** @type {Target | null} */ this.hovered = null;
    this.photographer = new Photographer(() => this.invalidate());
    this.world = new World({
      labels,
      robotTitle,
      select,
      groundChanged: () => this.#redraw(),
      changed: () => this.invalidate(),
    });
    this.robots = this.world.robots;
    this.camera = new Camera(canvas, () => this.invalidate());
    this.projection = new Projection(canvas, this.painter.size, () => this.eye);
    watchDrags({
      element: canvas,
      rayOf: (event) => (this.sketch() === null ? this.projection.rayOf(event) : null),
      dragController,
      isButton: (event) => buttons.isAt(event),
    });
    const buttons = watchPointer({
      element: canvas,
      camera: () => this.eye,
      targets: () =>
        this.sketch() === null ? this.robots.targets : [], // robots in the creator have no buttons
      press,
      hover: (target) => {
        if (target?.robot === this.hovered?.robot && target?.button === this.hovered?.button) return;
        this.hovered = target;
        canvas.style.cursor = target === null ? "" : "pointer";
        this.invalidate();
      },
    });
    this.invalidate();
  }

  /** Request one frame; several calls before it have the effect of one. */
  invalidate() {
    this.loop.invalidate();
  }

  /** @param {ViewName} view */
  setView(view) {
    this.camera.setView(view, this.#selectedPose());
  }

  /** The active camera. */
  get eye() {
    return this.painter.isFlat ? this.painter.flat.camera : this.camera.camera;
  }

  /** @param {boolean} flat */
  setFlat(flat) {
    this.painter.wantsFlat = flat;
    this.invalidate();
  }

  /** Day or evening. @param {import("./lights.js").Theme} theme */
  setTheme(theme) {
    lightAs(theme);
    this.#redraw();
  }

  /** Less movement: nothing flashes. @param {boolean} calm */
  setCalm(calm) {
    this.isCalm = calm;
    this.invalidate();
  }

  /** Space at the edges of the canvas that is covered, in CSS pixels. @param {import("./camera.js").Insets} insets */
  setInsets(insets) {
    this.camera.setInsets(insets);
    this.invalidate();
  }

  /** @param {boolean} shown */
  setNumbers(shown) {
    this.showNumbers = shown;
    this.invalidate();
  }

  /** @param {boolean} shown */
  setSensors(shown) {
    this.showSensors = shown;
    this.invalidate();
  }

  /** @param {string} choice  one of `QUALITIES` */
  setQuality(choice) {
    this.quality.choose(choice);
    this.invalidate();
  }

  /** Zoom in or out. @param {number} steps */
  zoom(steps) {
    if (this.painter.isFlat) this.painter.flat.zoomBy(steps);
    else this.camera.zoom(steps);
    this.invalidate();
  }

  /**
   * The view as PNG in full resolution, whatever the current quality; null if the browser cannot create it. This runs
   * in one task, so that the browser never shows a frame of the large canvas.
   *
   * @param {{ scale?: number }} [how]  times the usual size
   * @returns {Promise<Blob | null>}
   */
  picture({ scale = 1 } = {}) {
    const { flat, size } = this.painter;
    flat.pixelRatio = pictureRatio(size.css, window.devicePixelRatio, scale);
    this.#drawWhole(flat.pixelRatio); // WebGL content is readable only until the browser has shown the frame
    const { canvas } = this.painter;
    const picture = new Promise((/** @type {(png: Blob | null) => void} */ resolve) => canvas.toBlob(resolve, "image/png"));
    flat.pixelRatio = 1;
    this.#drawWhole(this.#ratio);
    this.quality.forget();
    this.invalidate();
    return picture;
  }

  /**
   * The position of a part in CSS pixels of the window; null while it is not drawn.
   *
   * @param {string} part
   * @param {string} [robot]
   */
  partPosition(part, robot = this.state().selected) {
    const place = this.robots.visibleModel(robot)?.partPosition(part) ?? null;
    return place === null ? null : this.projection.toWindow(place.x, place.y, place.z);
  }

  /** The size of one CSS pixel on the ground near the camera's target, in meters. */
  get pixelSize() {
    return this.painter.isFlat ? this.painter.flat.pixelSize : this.camera.pixelSize;
  }

  /** Fit the next world of the creator into the view. */
  reframe() {
    this.framed = false;
    this.invalidate();
  }

  /** Draw the state; returns whether something still moves. @param {number} nowMs */
  #frame(nowMs) {
    const state = this.state();
    this.beforeDraw(nowMs);
    this.photographer.drawNext(this.painter.has3d ? this.painter.renderer : null);
    this.painter.fit(this.#ratio, this.camera);
    const sketch = this.sketch();
    this.dragController.refresh();
    if (this.world.update(state, sketch, this.dragController)) {
      this.painter.still.forget();
      this.camera.frame(this.world.playground.corners(), sketch !== null && this.framed);
    }
    this.framed = sketch !== null;
    const moving = this.#updateRobots(state, nowMs);
    const pose = this.#selectedPose();
    if (pose !== null) this.camera.follow(pose);
    this.#draw(nowMs);
    this.#placeLabels();
    this.frames += 1;
    return moving;
  }

  /** Pixels per CSS pixel. */
  get #ratio() {
    return Math.min(window.devicePixelRatio, this.quality.settings.pixelRatio);
  }

  /** Draw now, with nothing kept from the frame before. @param {number} ratio */
  #drawWhole(ratio) {
    const nowMs = performance.now();
    this.painter.fit(ratio, this.camera);
    this.#updateRobots(this.state(), nowMs); // the larger they are, the finer is their model
    this.#draw(nowMs, true);
  }

  /** Desk and ground have changed. */
  #redraw() {
    this.painter.still.forget();
    this.invalidate();
  }

  /** @param {number} nowMs @param {boolean} [isWhole]  nothing kept from the frame before */
  #draw(nowMs, isWhole = false) {
    this.painter.draw(this.world, this.camera, { isWhole, drawFlat: () => this.#drawFlat(nowMs) });
  }

  /** @param {number} nowMs */
  #drawFlat(nowMs) {
    const { flat } = this.painter;
    const state = this.state();
    const names = Object.keys(state.robots);
    const { insets, corners, goesAlong } = this.camera;
    const covered = this.flatInsets();
    const { top = 0, bottom = 0 } = covered;
    const all = { ...insets, top: Math.max(insets.top ?? 0, top), bottom: Math.max(insets.bottom ?? 0, bottom) };
    flat.aim(corners, goesAlong ? this.#selectedPose() : null, all);
    flat.draw(state, {
      nowMs,
      senses: (name) => this.#isSensing(name),
      held: this.dragController.dragged,
      sketch: this.sketch(),
      color: (name) => robotColor(names, name),
      changed: () => this.invalidate(),
    });
  }

  /** @param {State} state @param {number} nowMs */
  #updateRobots(state, nowMs) {
    const { hovered } = this;
    return this.robots.update(state, {
      nowMs,
      hasGlows: this.quality.settings.hasGlows,
      isCalm: this.isCalm,
      hovered,
      isSensing: (name) => this.#isSensing(name),
      isSmall: (frame) => this.#isSmall(frame),
    });
  }

  /** Whether beams and ground patches of a robot are drawn. @param {string} name */
  #isSensing(name) {
    return this.showSensors && !this.framed && isSensed(this.state(), name);
  }

  /** Whether a robot at this position is too small on the screen for fine detail. @param {THREE.Matrix4} frame */
  #isSmall(frame) {
    const place = new THREE.Vector3().setFromMatrixPosition(frame);
    return this.camera.pixelsOf(SIZE_M, place) * this.painter.size.fitted.ratio < SMALL_PX;
  }

  #placeLabels() {
    const toCanvas = (/** @type {THREE.Vector3} */ place) => this.projection.toCanvas(place);
    this.robots.placeNames(toCanvas, this.painter.isFlat ? FLAT_LABEL_PX : 0);
    const { robots, selected } = this.state();
    const group = this.robots.visibleModel(selected)?.group;
    const numbers = this.showNumbers && group !== undefined ? valueLabelsOf(robots[selected]) : [];
    this.valueLabels.show(numbers, ({ x, y, z }) => group ? toCanvas(group.localToWorld(new THREE.Vector3(x, y, z))) : null);
  }

  #selectedPose() {
    const { robots, selected } = this.state();
    const pose = robots[selected]?.latest?.pose ?? null;
    return pose === null ? null : (this.robots.drawnPose(selected) ?? pose);
  }
}
