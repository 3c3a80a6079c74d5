// The 3D view: draws the state when something changed, in one animation loop. It makes no decisions.

import * as THREE from "three";

import { watchDrags } from "../move/drag.js";
import { Camera } from "./camera.js";
import { robotColor } from "../state/robot_colors.js";
import { FlatView } from "./flat.js";
import { Ghost } from "./ghost.js";
import { createRenderer, isSoftware } from "./graphics.js";
import { groundOf } from "./ground_of.js";
import { lightAs } from "./lights.js";
import { FrameLoop } from "./loop.js";
import { ValueLabels, valueLabelsOf } from "./value_labels.js";
import { photograph } from "./photographer.js";
import { PlaygroundModel } from "./playground.js";
import { watchPointer } from "./pointer.js";
import { pictureRatio, Quality } from "./quality.js";
import { RobotsLayer } from "./robots_layer.js";
import { SketchModel } from "./sketch.js";
import { drawAll, StillGround } from "./still_ground.js";
import { Surroundings } from "./surroundings.js";
import { isSensed } from "../state/names.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("./camera.js").ViewName} ViewName */
/** @typedef {import("./pointer.js").Target} Target */

/** If a lost WebGL context is not restored within this time, the view switches to 2D. */
const LOST_FOR_GOOD_MS = 4000;
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
   */
  constructor({ canvas, flatCanvas, labels, state, beforeDraw, press, dragController, robotTitle, select = () => {}, sketch, contextLost }) {
    this.canvas = canvas;
    this.state = state;
    this.beforeDraw = beforeDraw;
    this.dragController = dragController;
    this.ghost = new Ghost();
    this.sketch = sketch;
    this.sketchModel = new SketchModel();
    this.framed = false;
    this.frames = 0;
    this.size = { width: 0, height: 0 }; // CSS pixels; cached, since reading it after moving a label forces a layout
    this.showSensors = true;
    this.showNumbers = false;
    this.isCalm = false;
    this.renderer = createRenderer(canvas);
    this.isSoftware = isSoftware(this.renderer);
    this.quality = new Quality({ isSoftware: this.isSoftware });
    this.loop = new FrameLoop({
      quality: this.quality,
      draw: (nowMs) => this.#frame(nowMs),
      resize: () => this.#resize(),
    });
    this.valueLabels = new ValueLabels(labels);
    this.flat = new FlatView(flatCanvas);
    this.wantsFlat = false;
    this.isLost = false;
    /** @type {Target | null} */ this.hovered = null;
    /** @type {{ world: State, resolve: (picture: HTMLCanvasElement) => void }[]} */ this.photoRequests = [];
    this.scene = new THREE.Scene();
    this.still = new StillGround();
    this.surroundings = new Surroundings(() => this.#redraw());
    this.playground = new PlaygroundModel(() => this.#redraw(), undefined, { isStill: true });
    this.objects = new PlaygroundModel(() => this.invalidate());
    this.robots = new RobotsLayer({ scene: this.scene, labels, robotTitle, select });
    this.scene.add(this.surroundings.group, this.playground.group, this.objects.group, this.ghost.group, this.sketchModel.group);
    this.camera = new Camera(canvas, () => this.invalidate());
    let lostTimer = 0;
    canvas.addEventListener("webglcontextlost", () => {
      contextLost("lost");
      lostTimer = window.setTimeout(() => {
        this.isLost = true;
        contextLost("gone");
        this.invalidate();
      }, LOST_FOR_GOOD_MS);
    });
    canvas.addEventListener("webglcontextrestored", () => {
      window.clearTimeout(lostTimer);
      this.isLost = false;
      this.still.forget();
      contextLost(null);
      this.invalidate();
    });
    watchDrags({
      element: canvas,
      rayOf: (event) => (this.sketch() === null ? this.rayOf(event) : null),
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
    new ResizeObserver(() => this.#resize()).observe(canvas);
    this.#resize();
  }

  /** Request one frame; several calls before it have the effect of one. */
  invalidate() {
    this.loop.invalidate();
  }

  /** @param {ViewName} view */
  setView(view) {
    this.camera.setView(view, this.#selectedPose());
  }

  /** Whether 3D drawing is available now. */
  get has3d() {
    return this.renderer !== null && !this.isLost;
  }

  /** Whether the view is drawn in 2D from above, because 3D is missing or by choice. */
  get isFlat() {
    return this.wantsFlat || !this.has3d;
  }

  /** The active camera. */
  get eye() {
    return this.isFlat ? this.flat.camera : this.camera.camera;
  }

  /** @param {boolean} flat */
  setFlat(flat) {
    this.wantsFlat = flat;
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
  }

  /** @param {boolean} shown */
  setNumbers(shown) {
    this.showNumbers = shown;
    this.invalidate();
  }

  /** @param {string} choice  one of `QUALITIES` */
  setQuality(choice) {
    this.quality.choose(choice);
    this.#resize();
  }

  /** Zoom in or out. @param {number} steps */
  zoom(steps) {
    if (this.isFlat) this.flat.zoom = Math.min(8, Math.max(0.5, this.flat.zoom * 1.15 ** steps));
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
    const nowMs = performance.now();
    const ratio = pictureRatio(this.size, window.devicePixelRatio, scale);
    this.renderer?.setPixelRatio(ratio);
    this.flat.pixelRatio = ratio;
    this.#updateRobots(this.state(), nowMs); // robots that are large in the image need the fine model
    this.#draw(nowMs, true); // WebGL content is readable only until the browser has shown the frame
    const shown = this.isFlat ? this.flat.canvas : this.canvas;
    const picture = new Promise((/** @type {(png: Blob | null) => void} */ resolve) => shown.toBlob(resolve, "image/png"));
    this.flat.pixelRatio = 1;
    this.quality.forget();
    this.#resize();
    return picture;
  }

  /**
   * A thumbnail of another world, drawn in one of the next frames.
   *
   * @param {State} world
   * @returns {Promise<HTMLCanvasElement>}
   */
  photograph(world) {
    return new Promise((resolve) => {
      this.photoRequests.push({ world, resolve });
      this.invalidate();
    });
  }

  /** @param {boolean} shown */
  setSensors(shown) {
    this.showSensors = shown;
    this.invalidate();
  }

  /**
   * The position of a part in CSS pixels of the window; null while it is not drawn.
   *
   * @param {string} part
   * @param {string} [robot]
   */
  partPosition(part, robot = this.state().selected) {
    const place = this.robots.visibleModel(robot)?.partPosition(part) ?? null;
    return place === null ? null : this.#toWindow(place);
  }

  /** The line of sight through a pointer position. @param {{ clientX: number, clientY: number }} event */
  rayOf({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(place, this.eye);
    return caster.ray;
  }

  /** The size of one CSS pixel on the ground near the camera's target, in meters. */
  get pixelSize() {
    const { height } = this.size;
    if (this.isFlat) return (this.flat.camera.top - this.flat.camera.bottom) / Math.max(1, height);
    const { camera, controls } = this.camera;
    const far = camera.position.distanceTo(controls.target);
    return (2 * far * Math.tan((camera.fov * Math.PI) / 360)) / Math.max(1, height);
  }

  /** Fit the next world of the creator into the view. */
  reframe() {
    this.framed = false;
    this.invalidate();
  }

  /**
   * Project a point of the world to CSS pixels of the window.
   *
   * @param {number} x
   * @param {number} y
   * @param {number} z
   */
  screenPosition(x, y, z) {
    return this.#toWindow(new THREE.Vector3(x, y, z));
  }

  /** Draw the state; returns whether something still moves. @param {number} nowMs */
  #frame(nowMs) {
    const state = this.state();
    this.beforeDraw(nowMs);
    const sketch = this.sketch();
    const grown = this.playground.update(state.markers);
    if (grown) {
      this.still.forget();
      this.camera.frame(this.playground.corners(), sketch !== null && this.framed);
      this.surroundings.update(sketch === null ? groundOf(state.markers.values()) : null);
    }
    this.framed = sketch !== null;
    this.objects.update(state.objects);
    this.dragController.refresh();
    this.ghost.update(this.dragController.dragged, this.dragController.mode);
    this.sketchModel.update(sketch);
    const moving = this.#updateRobots(state, nowMs);
    const pose = this.#selectedPose();
    if (pose !== null) this.camera.follow(pose);
    const photoRequest = this.photoRequests.shift();
    photoRequest?.resolve(photograph(photoRequest.world, this.has3d ? this.renderer : null));
    this.#draw(nowMs);
    this.frames += 1;
    if (this.photoRequests.length > 0) this.invalidate();
    this.#placeLabels();
    return moving;
  }

  /** Desk and ground have changed. */
  #redraw() {
    this.still.forget();
    this.invalidate();
  }

  /** @param {THREE.WebGLRenderer} renderer @param {boolean} isWhole */
  #draw3d(renderer, isWhole) {
    const camera = this.camera.ready();
    // From a table robots fall, and its top then hides them: no image of the ground can.
    const mayBeKept = this.isSoftware && !isWhole && this.surroundings.ground?.isWalled === true;
    if (mayBeKept) this.still.draw(renderer, this.scene, camera);
    else drawAll(renderer, this.scene, camera);
  }

  /** @param {number} nowMs @param {boolean} [isWhole]  nothing kept from the frame before */
  #draw(nowMs, isWhole = false) {
    this.flat.canvas.hidden = !this.isFlat;
    if (!this.isFlat) {
      if (this.renderer !== null) this.#draw3d(this.renderer, isWhole);
      return;
    }
    const state = this.state();
    this.flat.aim(this.camera.corners, this.camera.goesAlong ? this.#selectedPose() : null);
    this.scene.updateMatrixWorld(); // the renderer would do this; hit tests need it
    const names = Object.keys(state.robots);
    this.flat.draw(state, {
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
    const { camera } = this.camera;
    const away = camera.position.distanceTo(new THREE.Vector3().setFromMatrixPosition(frame));
    const high = this.size.height * (this.renderer?.getPixelRatio() ?? 1);
    const pixelsPerRadian = high / (2 * Math.tan((camera.fov * Math.PI) / 360));
    return (SIZE_M / away) * pixelsPerRadian < SMALL_PX;
  }

  #placeLabels() {
    this.robots.placeNames((place) => this.#project(place), this.isFlat ? FLAT_LABEL_PX : 0);
    const { robots, selected } = this.state();
    const group = this.robots.visibleModel(selected)?.group;
    const numbers = this.showNumbers && group !== undefined ? valueLabelsOf(robots[selected]) : [];
    this.valueLabels.show(numbers, ({ x, y, z }) =>
      group === undefined ? null : this.#project(group.localToWorld(new THREE.Vector3(x, y, z))),
    );
  }

  #selectedPose() {
    const { robots, selected } = this.state();
    const pose = robots[selected]?.latest?.pose ?? null;
    return pose === null ? null : (this.robots.drawnPose(selected) ?? pose);
  }

  /** World → CSS pixels of the canvas. @param {THREE.Vector3} place */
  #project(place) {
    const { x, y, z } = place.project(this.eye);
    if (z > 1 || z < -1) return null;
    return { x: ((x + 1) / 2) * this.size.width, y: ((1 - y) / 2) * this.size.height };
  }

  /** @param {THREE.Vector3} place */
  #toWindow(place) {
    const inside = this.#project(place);
    const { left, top } = this.canvas.getBoundingClientRect();
    return inside === null ? null : { x: left + inside.x, y: top + inside.y };
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.size = { width: clientWidth, height: clientHeight };
    this.renderer?.setPixelRatio(Math.min(window.devicePixelRatio, this.quality.settings.pixelRatio));
    this.renderer?.setSize(clientWidth, clientHeight, false);
    this.camera.resize(clientWidth, clientHeight);
    this.invalidate();
  }
}
