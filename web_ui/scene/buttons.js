// The five buttons on the robot's top: they light up under the pointer and sink when pressed.
// An invisible, larger disc around each is what pointer and finger hit.

import * as THREE from "three";

import { BUTTON_PLACES } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

const TOUCH_RADIUS_M = 0.0078;
const RAISED_M = 0.0014;
const COLOURS = { idle: 0x8794a3, hover: 0x1769d1, pressed: 0x0b2f66 };
const HEADINGS = /** @type {Record<string, number>} */ ({ forward: 0, left: 90, backward: 180, right: -90 });

export function createButtons() {
  const round = new THREE.CylinderGeometry(0.0044, 0.0044, RAISED_M, 22).rotateX(Math.PI / 2);
  const arrow = new THREE.ExtrudeGeometry(
    new THREE.Shape([
      new THREE.Vector2(0.0048, 0),
      new THREE.Vector2(-0.0032, 0.005),
      new THREE.Vector2(-0.0032, -0.005),
    ]),
    { depth: RAISED_M, bevelEnabled: false },
  ).translate(0, 0, -RAISED_M / 2);
  const touch = new THREE.CircleGeometry(TOUCH_RADIUS_M, 16);
  const unseen = new THREE.MeshBasicMaterial({ visible: false });
  const group = new THREE.Group();
  /** @type {THREE.Mesh[]} */ const targets = [];
  const buttons = Object.entries(BUTTON_PLACES).map(([name, place]) => {
    const material = new THREE.MeshLambertMaterial({ color: COLOURS.idle });
    const mesh = new THREE.Mesh(name === "center" ? round : arrow, material);
    mesh.rotation.z = ((HEADINGS[name] ?? 0) * Math.PI) / 180;
    mesh.position.set(place.x, place.y, place.z + RAISED_M / 2);
    const target = new THREE.Mesh(touch, unseen);
    target.position.set(place.x, place.y, place.z + RAISED_M);
    target.userData.button = name;
    targets.push(target);
    group.add(mesh, target);
    return { name, place, mesh, material };
  });
  return {
    group,
    targets,
    /** @param {Robot} robot @param {string | null} hovered */
    update(robot, hovered) {
      for (const { name, place, mesh, material } of buttons) {
        const pressed = robot.buttons[name];
        material.color.set(pressed ? COLOURS.pressed : name === hovered ? COLOURS.hover : COLOURS.idle);
        mesh.position.z = place.z + (pressed ? 0.0001 : RAISED_M / 2);
      }
    },
    dispose() {
      for (const thing of [round, arrow, touch, unseen, ...buttons.map(({ material }) => material)]) thing.dispose();
    },
  };
}
