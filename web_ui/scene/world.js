// Everything that is drawn: the playground and what is around it, objects, robots, and what lies over them while
// something is dragged or built.

import * as THREE from "three";

import { Ghost } from "./ghost.js";
import { groundOf } from "./ground_of.js";
import { PlaygroundModel } from "./playground.js";
import { RobotsLayer } from "./robots_layer.js";
import { SketchModel } from "./sketch.js";
import { Surroundings } from "./surroundings.js";

/** @typedef {import("../state/index.js").State} State */

export class World {
  /**
   * @param {object} options
   * @param {HTMLElement} options.labels       layer for the robots' names
   * @param {(name: string) => string} options.robotTitle
   * @param {(robot: string) => void} options.select   a robot's dot has been clicked
   * @param {() => void} options.groundChanged
   * @param {() => void} options.changed       something else has
   */
  constructor({ labels, robotTitle, select, groundChanged, changed }) {
    this.scene = new THREE.Scene();
    this.ghost = new Ghost();
    this.sketchModel = new SketchModel();
    this.surroundings = new Surroundings(groundChanged);
    this.playground = new PlaygroundModel(groundChanged, undefined, { isStill: true });
    this.objects = new PlaygroundModel(changed);
    this.mission = new PlaygroundModel(changed);
    this.robots = new RobotsLayer({ scene: this.scene, labels, robotTitle, select });
    for (const part of [this.surroundings, this.playground, this.objects, this.mission, this.ghost, this.sketchModel]) {
      this.scene.add(part.group);
    }
  }

  /** Whether walls stand around the ground, so that nothing falls off it. */
  get isWalled() {
    return this.surroundings.ground?.isWalled === true;
  }

  /**
   * Everything but the robots; returns whether the ground is another.
   *
   * @param {State} state
   * @param {import("../creator/sketch.js").Sketch | null} sketch   overlay of the creator; null while it is closed
   * @param {import("../move/drag_controller.js").DragController} dragController
   */
  update(state, sketch, dragController) {
    const isOther = this.playground.update(state.markers);
    if (isOther) this.surroundings.update(sketch === null ? groundOf(state.markers.values()) : null);
    this.objects.update(state.objects);
    this.mission.update(state.missionMarkers);
    this.ghost.update(dragController.dragged, dragController.mode);
    this.sketchModel.update(sketch);
    return isOther;
  }
}
