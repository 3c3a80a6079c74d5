// The five buttons on top of the robot: highlighted under the pointer, lowered when pressed.
// The hit target of each is a larger, invisible disc.

import * as THREE from "three";

import { Instances, placeOf } from "./instances.js";
import { BUTTON_PLACES } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const TOUCH_RADIUS_M = 0.0078;
const RAISED_M = 0.0014;
const COLORS = {
  idle: new THREE.Color(0x8794a3),
  hover: new THREE.Color(0x1769d1),
  pressed: new THREE.Color(0x0b2f66),
};
/** Direction in degrees from straight ahead; the center button has none. */
const HEADINGS = /** @type {Record<string, number>} */ ({ forward: 0, left: 90, backward: 180, right: -90 });

/** @param {import("./robot_instances.js").Capacity} room */
export function createButtons({ robots }) {
  const round = new THREE.CylinderGeometry(0.0044, 0.0044, RAISED_M, 22).rotateX(Math.PI / 2);
  const arrow = new THREE.ExtrudeGeometry(
    new THREE.Shape([
      new THREE.Vector2(0.0048, 0),
      new THREE.Vector2(-0.0032, 0.005),
      new THREE.Vector2(-0.0032, -0.005),
    ]),
    { depth: RAISED_M, bevelEnabled: false },
  ).translate(0, 0, -RAISED_M / 2);
  const headings = Object.entries(HEADINGS);
  const rounds = new Instances(round, new THREE.MeshLambertMaterial(), { each: 1, robots });
  const arrows = new Instances(arrow, new THREE.MeshLambertMaterial(), { each: headings.length, robots });
  /** @param {Instances} part @param {number} slot @param {number} index @param {string} name @param {Look} look */
  const draw = (part, slot, index, name, { robot, hovered }) => {
    const pressed = robot.buttons[name];
    const { x, y, z } = BUTTON_PLACES[name];
    const angle = ((HEADINGS[name] ?? 0) * Math.PI) / 180;
    part.put(slot, index, placeOf({ x, y, z: z + (pressed ? 0.0001 : RAISED_M / 2) }, { angle }));
    part.tint(slot, index, COLORS[pressed ? "pressed" : name === hovered ? "hover" : "idle"]);
  };
  return {
    parts: [rounds, arrows],
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, look, before) {
      if (before !== null && before.robot.buttons === look.robot.buttons && before.hovered === look.hovered) return;
      draw(rounds, slot, 0, "center", look);
      headings.forEach(([name], index) => draw(arrows, slot, index, name, look));
    },
  };
}

/** The hit targets, in the robot's frame. @param {string} robot */
export function createTargets(robot) {
  const geometry = new THREE.CircleGeometry(TOUCH_RADIUS_M, 16);
  const material = new THREE.MeshBasicMaterial({ visible: false });
  const meshes = Object.entries(BUTTON_PLACES).map(([button, { x, y, z }]) => {
    const mesh = new THREE.Mesh(geometry, material);
    mesh.position.set(x, y, z + RAISED_M);
    mesh.userData = { robot, button };
    return mesh;
  });
  return {
    meshes,
    dispose() {
      geometry.dispose();
      material.dispose();
    },
  };
}
