// The 3D view: draws the state when something changed, in one animation loop. It never decides.

import * as THREE from "three";

import { watchDrags } from "../move/drag.js";
import { Camera } from "./camera.js";
import { Ghost } from "./ghost.js";
import { PlaygroundModel } from "./playground.js";
import { watchPointer } from "./pointer.js";
import { Quality } from "./quality.js";
import { RobotModel } from "./robot.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("./camera.js").ViewName} ViewName */
/** @typedef {import("./pointer.js").Target} Target */

const SKY = 0xdfecf6;
const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

export class SceneView {
  /**
   * @param {object} options
   * @param {HTMLCanvasElement} options.canvas
   * @param {HTMLElement} options.labels       layer for the robots' names
   * @param {() => State} options.state
   * @param {(nowMs: number) => void} options.beforeDraw   the panels' turn in the same frame
   * @param {(target: Target, pressed: boolean) => void} options.press
   * @param {import("../move/mover.js").Mover} options.mover   what a hand carries
   * @param {(name: string) => string} options.robotTitle
   * @param {(lost: boolean) => void} options.contextLost
   */
  constructor({ canvas, labels, state, beforeDraw, press, mover, robotTitle, contextLost }) {
    this.canvas = canvas;
    this.labels = labels;
    this.state = state;
    this.beforeDraw = beforeDraw;
    this.robotTitle = robotTitle;
    this.mover = mover;
    this.ghost = new Ghost();
    this.frames = 0;
    this.requested = false;
    this.showSensors = true;
    /** @type {Target | null} */ this.hovered = null;
    /** @type {Map<string, { model: RobotModel, trail: PlaygroundModel, label: HTMLElement }>} */ this.robots = new Map();
    this.scene = new THREE.Scene();
    this.scene.background = new THREE.Color(SKY);
    this.playground = new PlaygroundModel(() => this.invalidate());
    this.objects = new PlaygroundModel(() => this.invalidate());
    const sun = new THREE.DirectionalLight(0xffffff, 1.75);
    sun.position.set(-1.2, -1.6, 3);
    const fill = new THREE.DirectionalLight(0xffffff, 0.5); // so that faces turned away from the sun are not dull
    fill.position.set(1, 1.4, 0.35);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0xccd5de, 1.75), sun, fill);
    this.scene.add(this.playground.group, this.objects.group, this.ghost.group);
    this.camera = new Camera(canvas, () => this.invalidate());
    this.renderer = createRenderer(canvas);
    const software = this.renderer !== null && SOFTWARE.test(graphicsName(this.renderer));
    this.quality = new Quality(software ? 1 : 0);
    canvas.addEventListener("webglcontextlost", () => contextLost(true));
    canvas.addEventListener("webglcontextrestored", () => {
      contextLost(false);
      this.invalidate();
    });
    watchDrags({ element: canvas, rayOf: (event) => this.#rayOf(event), mover });
    watchPointer({
      element: canvas,
      camera: this.camera.camera,
      targets: () =>
        [...this.robots.values()].flatMap(({ model }) => (model.group.visible ? model.buttons.targets : [])),
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

  /** Ask for one frame; any number of calls before it are one. */
  invalidate() {
    if (this.requested) return;
    this.requested = true;
    requestAnimationFrame((nowMs) => this.#frame(nowMs));
  }

  /** @param {ViewName} view */
  look(view) {
    this.camera.look(view, this.#selectedPose());
  }

  /** @param {boolean} shown */
  setSensors(shown) {
    this.showSensors = shown;
    this.invalidate();
  }

  /**
   * A part's place in CSS pixels of the window; null while it is not drawn.
   *
   * @param {string} part
   * @param {string} [robot]
   */
  partPosition(part, robot = this.state().selected) {
    const model = this.robots.get(robot)?.model;
    const place = model?.group.visible ? model.partPosition(part) : null;
    return place == null ? null : this.#toWindow(place);
  }

  /** The line of sight through a pointer. @param {PointerEvent} event */
  #rayOf({ clientX, clientY }) {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const place = new THREE.Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    const caster = new THREE.Raycaster();
    caster.setFromCamera(place, this.camera.camera);
    return caster.ray;
  }

  /** Where a point of the world is in CSS pixels of the window. @param {number} x @param {number} y @param {number} z */
  screenPosition(x, y, z) {
    return this.#toWindow(new THREE.Vector3(x, y, z));
  }

  /** @param {number} nowMs */
  #frame(nowMs) {
    this.requested = false;
    const state = this.state();
    this.beforeDraw(nowMs);
    if (this.playground.update(state.markers)) this.camera.frame(this.playground.corners());
    this.objects.update(state.objects);
    this.mover.refresh();
    this.ghost.update(this.mover.held, this.mover.mode);
    const moving = this.#updateRobots(state, nowMs);
    const pose = this.#selectedPose();
    if (pose !== null) this.camera.follow(pose);
    this.renderer?.render(this.scene, this.camera.camera);
    this.frames += 1;
    this.#placeLabels();
    if (moving) this.invalidate();
    if (this.quality.note(nowMs, moving)) this.#resize();
  }

  /** @param {State} state @param {number} nowMs */
  #updateRobots(state, nowMs) {
    for (const [name, { model, trail, label }] of [...this.robots]) {
      if (name in state.robots) continue;
      this.scene.remove(model.group, trail.group);
      model.dispose();
      trail.dispose();
      label.remove();
      this.robots.delete(name);
    }
    let moving = false;
    for (const [name, robot] of Object.entries(state.robots)) {
      let entry = this.robots.get(name);
      if (entry === undefined) {
        entry = { model: new RobotModel(name), trail: new PlaygroundModel(), label: document.createElement("span") };
        entry.label.className = "robot-label";
        this.labels.append(entry.label);
        this.scene.add(entry.model.group, entry.trail.group);
        this.robots.set(name, entry);
      }
      entry.trail.update(robot.trail);
      const hovered = this.hovered?.robot === name ? this.hovered.button : null;
      moving = entry.model.update(robot, hovered, nowMs) || moving;
      for (const { group } of entry.model.sensing) group.visible = this.showSensors;
      entry.label.textContent = this.robotTitle(name);
    }
    return moving;
  }

  #placeLabels() {
    for (const { model, label } of this.robots.values()) {
      const place = model.group.visible ? this.#project(model.group.position.clone().setZ(0.115)) : null;
      label.hidden = place === null;
      if (place !== null) label.style.transform = `translate(${place.x}px, ${place.y}px) translate(-50%, -100%)`;
    }
  }

  #selectedPose() {
    const { robots, selected } = this.state();
    const pose = robots[selected]?.latest?.pose ?? null;
    const group = this.robots.get(selected)?.model.group;
    return pose === null || group === undefined
      ? pose
      : { x: group.position.x, y: group.position.y, yaw: group.rotation.z };
  }

  /** World → CSS pixels of the canvas. @param {THREE.Vector3} place */
  #project(place) {
    const { x, y, z } = place.project(this.camera.camera);
    if (z > 1) return null;
    return { x: ((x + 1) / 2) * this.canvas.clientWidth, y: ((1 - y) / 2) * this.canvas.clientHeight };
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
    this.renderer?.setPixelRatio(Math.min(window.devicePixelRatio, this.quality.settings.pixelRatio));
    this.renderer?.setSize(clientWidth, clientHeight, false);
    this.camera.resize(clientWidth, clientHeight);
    this.invalidate();
  }
}

/** Null where the browser has no WebGL: panels and d-pad still work. @param {HTMLCanvasElement} canvas */
function createRenderer(canvas) {
  try {
    const renderer = new THREE.WebGLRenderer({ canvas, antialias: !isSoftware(), powerPreference: "low-power" });
    renderer.outputColorSpace = THREE.SRGBColorSpace;
    return renderer;
  } catch {
    return null;
  }
}

/** Software drawing pays for every sample: asked on a canvas of its own, before the real one is made. */
function isSoftware() {
  const probe = document.createElement("canvas").getContext("webgl2");
  const name = probe === null ? "" : nameOf(probe);
  probe?.getExtension("WEBGL_lose_context")?.loseContext();
  return SOFTWARE.test(name);
}

/** @param {THREE.WebGLRenderer} renderer */
function graphicsName(renderer) {
  return nameOf(renderer.getContext());
}

/** @param {WebGLRenderingContext | WebGL2RenderingContext} gl */
function nameOf(gl) {
  const info = gl.getExtension("WEBGL_debug_renderer_info");
  return info === null ? "" : String(gl.getParameter(info.UNMASKED_RENDERER_WEBGL));
}
