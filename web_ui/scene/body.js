// The shell of the robot: outline (flat back, round front), wheel arches, pen hole, LEGO studs.

import * as THREE from "three";

import { glow } from "./glow.js";
import { Instances } from "./instances.js";
import { merged } from "./merged.js";
import { HEIGHT_M, WHEEL } from "./parts.js";

const HALF_WIDTH_M = 0.056;
const REAR_M = -0.03;
const FRONT_RADIUS_M = 0.08;
const FLOOR_M = 0.005;
const BELT_M = 0.0455; // lower edge of the upper shell, just above the wheels
const CORNER_M = 0.008;
const ARCH = { half: 0.0245, inner: 0.0385 };

const WHITE = 0xf7f8fa;
const LOWER = 0xe7ebef;
const DARK = 0x2b333c;
const TYRE = 0x343b44;

/** @typedef {import("./robot_instances.js").Look} Look */

const TINT = 0.72; // share of the top light's color in the shell at full brightness
const SHINE = 0.12; // increase of brightness at full light
const SHELL = new THREE.Color(WHITE);
const HERE = new THREE.Matrix4();

/** @param {import("./robot_instances.js").Capacity} room */
export function createBody({ robots }) {
  const counts = { each: 1, robots };
  const hole = new THREE.CircleGeometry(0.0062, 24).translate(0, 0, HEIGHT_M + 0.0003);
  const rim = new THREE.RingGeometry(0.0062, 0.0082, 24).translate(0, 0, HEIGHT_M + 0.0003);
  const lower = merged([
    [extruded(outline(true), FLOOR_M, BELT_M - 0.0012), LOWER],
    [extruded(outline(false, 0.0018), BELT_M - 0.0025, BELT_M + 0.001), DARK],
    [hole, DARK],
    [rim, LOWER],
  ]);
  const upper = merged([
    [extruded(outline(false), BELT_M, HEIGHT_M, { bevel: 0.0025 }), 0xffffff],
    [studGeometry(), 0xffffff],
  ]);
  const base = new Instances(lower, new THREE.MeshLambertMaterial({ vertexColors: true }), counts);
  const shell = new Instances(upper, new THREE.MeshLambertMaterial(), counts);
  const color = new THREE.Color();
  return {
    parts: [base, shell],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot }) {
      base.put(slot, 0, HERE);
      shell.put(slot, 0, HERE);
      shell.tint(slot, 0, shellColor(color, robot));
    },
  };
}

/**
 * A robot that is small on the screen: body and wheels in one piece.
 *
 * @param {import("./robot_instances.js").Capacity} room
 */
export function createFarBody({ robots }) {
  const wheel = () => new THREE.CylinderGeometry(WHEEL.radius, WHEEL.radius, WHEEL.width, 8);
  const shape = merged([
    [extruded(outline(false), BELT_M, HEIGHT_M, { corners: 2 }), 0xffffff],
    [extruded(outline(true), FLOOR_M, BELT_M, { corners: 2 }), LOWER],
    [wheel().translate(0, WHEEL.track / 2, WHEEL.radius), TYRE],
    [wheel().translate(0, -WHEEL.track / 2, WHEEL.radius), TYRE],
  ]);
  const body = new Instances(shape, new THREE.MeshLambertMaterial({ vertexColors: true }), { each: 1, robots });
  const color = new THREE.Color();
  return {
    parts: [body],
    /** @param {number} slot @param {Look} look */
    show(slot, { robot }) {
      body.put(slot, 0, HERE);
      body.tint(slot, 0, shellColor(color, robot));
    },
  };
}

/**
 * The color of the shell with the top light shining through it.
 *
 * @param {THREE.Color} color  is set
 * @param {import("../state/robot.js").Robot} robot
 */
function shellColor(color, { leds: { top } }) {
  glow(color, SHELL, top, TINT);
  return color.multiplyScalar(1 + SHINE * Math.max(0, ...(top ?? [])));
}

/**
 * The outline seen from above, with notches for the wheels.
 *
 * @param {boolean} arches
 * @param {number} inset
 */
function outline(arches, inset = 0) {
  const half = HALF_WIDTH_M - inset;
  const rear = REAR_M + inset;
  const radius = FRONT_RADIUS_M - inset;
  const angle = Math.asin(half / radius);
  const shape = new THREE.Shape();
  shape.moveTo(rear, -half + CORNER_M);
  shape.quadraticCurveTo(rear, -half, rear + CORNER_M, -half);
  if (arches) notch(shape, -half, -ARCH.inner, -ARCH.half, ARCH.half);
  shape.lineTo(radius * Math.cos(angle) - 0.006, -half);
  shape.absarc(0, 0, radius, -angle + 0.04, angle - 0.04, false);
  shape.lineTo(radius * Math.cos(angle) - 0.006, half);
  if (arches) notch(shape, half, ARCH.inner, ARCH.half, -ARCH.half);
  shape.lineTo(rear + CORNER_M, half);
  shape.quadraticCurveTo(rear, half, rear, half - CORNER_M);
  shape.closePath();
  return shape;
}

/**
 * @param {THREE.Shape} shape
 * @param {number} outer
 * @param {number} inner
 * @param {number} from
 * @param {number} to
 */
function notch(shape, outer, inner, from, to) {
  shape.lineTo(from, outer);
  shape.lineTo(from, inner);
  shape.lineTo(to, inner);
  shape.lineTo(to, outer);
}

/**
 * @param {THREE.Shape} shape
 * @param {number} bottom
 * @param {number} top
 * @param {{ bevel?: number, corners?: number }} [how]  meters; corners of a round edge
 */
function extruded(shape, bottom, top, { bevel = 0, corners = 10 } = {}) {
  const geometry = new THREE.ExtrudeGeometry(shape, {
    depth: top - bottom - 2 * bevel,
    bevelEnabled: bevel > 0,
    bevelThickness: bevel,
    bevelSize: bevel,
    bevelOffset: -bevel,
    bevelSegments: 2,
    curveSegments: corners,
  });
  return geometry.translate(0, 0, bottom + bevel);
}

/** Four rows of studs behind the buttons, as one geometry. */
function studGeometry() {
  const stud = new THREE.CylinderGeometry(0.0024, 0.0024, 0.0016, 10, 1).rotateX(Math.PI / 2).toNonIndexed();
  const places = [-0.04, -0.032, 0.032, 0.04].flatMap((y) => [-0.016, -0.008, 0, 0.008].map((x) => [x, y]));
  const size = stud.attributes.position.count * 3;
  const positions = new Float32Array(size * places.length);
  const normals = new Float32Array(size * places.length);
  places.forEach(([x, y], index) => {
    const moved = stud.clone().translate(x, y, HEIGHT_M + 0.0008);
    positions.set(moved.attributes.position.array, index * size);
    normals.set(moved.attributes.normal.array, index * size);
    moved.dispose();
  });
  stud.dispose();
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(normals, 3));
  return geometry;
}
