// Thumbnails of worlds, drawn one at a time with the renderer of the view: in a corner of its canvas,
// before the view is drawn over it in the same frame.

import * as THREE from "three";

import { robotColor } from "../state/robot_colors.js";
import { fit } from "./fit.js";
import { FlatView } from "./flat.js";
import { RobotInstances } from "./robot_instances.js";
import { PlaygroundModel } from "./playground.js";
import { RobotModel } from "./robot.js";

/** @typedef {import("../state/index.js").State} State */

/** Behind a thumbnail there is paper, no desk. */
const CARD = new THREE.Color(0xe9ddc9);
const FROM = new THREE.Vector3(-0.22, -0.85, 0.95).normalize();
/** Oversampling, which smooths the edges. */
const SIZE = { width: 480, height: 320 };

export class Photographer {
  /** @param {() => void} wanted   there is something to draw in the next frame */
  constructor(wanted) {
    this.wanted = wanted;
    /** @type {{ world: State, resolve: (picture: HTMLCanvasElement) => void }[]} */ this.requests = [];
  }

  /** A thumbnail, drawn in one of the next frames. @param {State} world @returns {Promise<HTMLCanvasElement>} */
  request(world) {
    return new Promise((resolve) => {
      this.requests.push({ world, resolve });
      this.wanted();
    });
  }

  /** Draw the next one; call it before the view is drawn. @param {THREE.WebGLRenderer | null} renderer  null: 2D from above */
  drawNext(renderer) {
    const request = this.requests.shift();
    if (request === undefined) return;
    request.resolve(renderer === null ? fromAbove(request.world) : inSpace(request.world, renderer));
    if (this.requests.length > 0) this.wanted();
  }
}

/** @param {State} world @param {THREE.WebGLRenderer} renderer */
function inSpace(world, renderer) {
  const scene = new THREE.Scene();
  scene.background = CARD;
  const playground = new PlaygroundModel();
  playground.update(world.markers);
  const robots = Object.entries(world.robots).map(([name, robot]) => {
    const model = new RobotModel(name);
    model.update(robot, 0);
    return model;
  });
  const instances = new RobotInstances({ fine: true });
  instances.update(
    robots.map(({ name, group }) => ({
      look: { robot: world.robots[name], hovered: null, sensing: false, flash: 0 },
      frame: group.matrix,
    })),
  );
  scene.add(playground.group, instances.group);
  const target = renderer.domElement;
  const [width, height] = [Math.min(SIZE.width, target.width), Math.min(SIZE.height, target.height)];
  const camera = new THREE.PerspectiveCamera(30, width / height, 0.02, 400);
  camera.up.set(0, 0, 1);
  const place = fit(camera, cornersOf(playground, robots), FROM);
  camera.position.copy(FROM).multiplyScalar(place.distance).add(place.target);
  camera.lookAt(place.target);

  const ratio = renderer.getPixelRatio();
  const whole = renderer.getSize(new THREE.Vector2());
  renderer.setViewport(0, 0, width / ratio, height / ratio);
  renderer.setScissor(0, 0, width / ratio, height / ratio);
  renderer.setScissorTest(true);
  renderer.render(scene, camera);
  renderer.setScissorTest(false);
  renderer.setViewport(0, 0, whole.x, whole.y);

  const canvas = emptyCanvas();
  const context = canvas.getContext("2d");
  context?.drawImage(target, 0, target.height - height, width, height, 0, 0, canvas.width, canvas.height);
  playground.dispose();
  instances.dispose();
  for (const robot of robots) robot.dispose();
  return canvas;
}

/** @param {State} world */
function fromAbove(world) {
  const canvas = emptyCanvas();
  const playground = new PlaygroundModel();
  playground.update(world.markers);
  const view = new FlatView(canvas);
  view.aim(cornersOf(playground, []), null);
  const names = Object.keys(world.robots);
  view.draw(world, {
    nowMs: 0,
    senses: () => false,
    held: null,
    sketch: null,
    color: (name) => robotColor(names, name),
    changed: () => {},
  });
  playground.dispose();
  return canvas;
}

/** @param {PlaygroundModel} playground @param {RobotModel[]} robots */
function cornersOf(playground, robots) {
  const corners = playground.corners();
  for (const { group } of robots) {
    for (const [x, y] of [
      [-0.1, -0.1],
      [0.1, 0.1],
    ])
      corners.push(group.position.clone().add(new THREE.Vector3(x, y, 0.05)));
  }
  return corners.length > 0 ? corners : [new THREE.Vector3(-0.3, -0.3, 0), new THREE.Vector3(0.3, 0.3, 0)];
}

function emptyCanvas() {
  return Object.assign(document.createElement("canvas"), SIZE);
}
