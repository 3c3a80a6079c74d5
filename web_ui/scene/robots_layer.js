// All robots of the drawn world: their models, pen trails and name tags; large ones are drawn in fine detail.

import * as THREE from "three";

import { robotColor } from "../state/robot_colors.js";
import { PlaygroundModel } from "./playground.js";
import { RobotModel } from "./robot.js";
import { RobotInstances } from "./robot_instances.js";
import { Flashes } from "./flash.js";
import { NameTags, numberOf } from "./tags.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("./pointer.js").Target} Target */

/** Height of the name above the ground. */
const NAME_M = 0.115;

export class RobotsLayer {
  /**
   * @param {object} options
   * @param {THREE.Scene} options.scene
   * @param {HTMLElement} options.labels       layer for the names
   * @param {(name: string) => string} options.robotTitle
   * @param {(robot: string) => void} options.select
   */
  constructor({ scene, labels, robotTitle, select }) {
    this.scene = scene;
    this.robotTitle = robotTitle;
    this.flashes = new Flashes();
    this.tags = new NameTags(labels, select);
    /** @type {Map<string, { model: RobotModel, trail: PlaygroundModel }>} */ this.robots = new Map();
    this.near = new RobotInstances({ fine: true });
    this.far = new RobotInstances({ fine: false });
    scene.add(this.near.group, this.far.group);
  }

  /** The hit targets of the visible robots. */
  get targets() {
    return [...this.robots.values()].flatMap(({ model }) => (model.group.visible ? model.targets.meshes : []));
  }

  /** The model of a robot; null while it is not drawn. @param {string} name */
  visibleModel(name) {
    const model = this.robots.get(name)?.model;
    return model?.group.visible ? model : null;
  }

  /** The drawn pose of a robot; null for one without a model. @param {string} name */
  drawnPose(name) {
    const group = this.robots.get(name)?.model.group;
    return group === undefined ? null : { x: group.position.x, y: group.position.y, yaw: group.rotation.z };
  }

  /**
   * Update models, trails and names; returns whether an interpolation is still in progress.
   *
   * @param {State} state
   * @param {object} options
   * @param {number} options.nowMs
   * @param {Target | null} options.hovered
   * @param {(name: string) => boolean} options.isSensing   whether the beams of a robot are drawn
   * @param {(frame: THREE.Matrix4) => boolean} options.isSmall   whether a robot there is drawn in coarse detail
   * @param {boolean} options.hasGlows
   * @param {boolean} options.isCalm     nothing flashes
   */
  update(state, { nowMs, hovered, isSensing, isSmall, hasGlows, isCalm }) {
    this.#removeOthers(state);
    let moving = false;
    const names = Object.keys(state.robots);
    for (const [name, robot] of Object.entries(state.robots)) {
      const { model, trail } = this.#entryOf(name);
      trail.update(robot.trail);
      moving = model.update(robot, nowMs) || moving;
      const sounds = robot.sound[0] > 0 || robot.sound[1] > 0;
      if (names.length < 2) {
        this.tags.remove(name);
        continue;
      }
      this.tags.show(name, {
        title: (sounds ? "♪ " : "") + this.robotTitle(name),
        number: numberOf(name, names.indexOf(name) + 1),
        color: robotColor(names, name),
        isSelected: name === state.selected,
        isHovered: name === hovered?.robot,
        hasTrouble: needsHelp(state, name),
      });
    }
    const drawn = names.flatMap((name) => {
      const frame = this.visibleModel(name)?.group.matrix;
      if (frame === undefined) return [];
      const button = hovered?.robot === name ? hovered.button : null;
      const flash = isCalm ? 0 : this.flashes.of(state, name, nowMs);
      moving = flash > 0 || moving;
      return [{ look: { robot: state.robots[name], hovered: button, sensing: isSensing(name), flash }, frame }];
    });
    for (const set of [this.near, this.far]) set.setGlows(hasGlows);
    this.near.update(drawn.filter(({ frame }) => !isSmall(frame)));
    this.far.update(drawn.filter(({ frame }) => isSmall(frame)));
    return moving;
  }

  /**
   * Move the names to their robots.
   *
   * @param {(place: THREE.Vector3) => { x: number, y: number } | null} project   to CSS pixels of the layer
   * @param {number} abovePx
   */
  placeNames(project, abovePx) {
    const positions = new Map(
      [...this.robots].map(([name, { model }]) => {
        const position = model.group.visible ? project(model.group.position.clone().setZ(NAME_M)) : null;
        return [name, position && { x: position.x, y: position.y - abovePx }];
      }),
    );
    this.tags.place(positions);
  }

  /** @param {State} state */
  #removeOthers(state) {
    for (const [name, { model, trail }] of [...this.robots]) {
      if (name in state.robots) continue;
      this.scene.remove(model.group, trail.group);
      model.dispose();
      trail.dispose();
      this.tags.remove(name);
      this.robots.delete(name);
    }
  }

  /** @param {string} name */
  #entryOf(name) {
    let entry = this.robots.get(name);
    if (entry === undefined) {
      entry = { model: new RobotModel(name), trail: new PlaygroundModel() };
      this.scene.add(entry.model.group, entry.trail.group);
      this.robots.set(name, entry);
    }
    return entry;
  }
}

/** Whether a person should look at this robot: it fell, or its program has ended by a fault. @param {State} state @param {string} name */
function needsHelp({ simulator, programs }, name) {
  return (simulator?.fallen?.includes(name) ?? false) || programs[name]?.state === "fault";
}
