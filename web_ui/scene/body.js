// The shell: outline of the real robot (flat back, round front), wheel arches, pen hole, LEGO studs.

import * as THREE from "three";

import { HEIGHT_M } from "./parts.js";

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

/** @typedef {{ group: THREE.Group, top: THREE.MeshLambertMaterial, dispose: () => void }} Body */

/** @returns {Body} */
export function createBody() {
  const materials = {
    top: new THREE.MeshLambertMaterial({ color: WHITE }),
    lower: new THREE.MeshLambertMaterial({ color: LOWER }),
    dark: new THREE.MeshLambertMaterial({ color: DARK }),
  };
  const lower = extruded(outline(true), FLOOR_M, BELT_M - 0.0012, 0);
  const gap = extruded(outline(false, 0.0018), BELT_M - 0.0025, BELT_M + 0.001, 0);
  const shell = extruded(outline(false), BELT_M, HEIGHT_M, 0.0025);
  const hole = new THREE.CircleGeometry(0.0062, 24).translate(0, 0, HEIGHT_M + 0.0003);
  const rim = new THREE.RingGeometry(0.0062, 0.0082, 24).translate(0, 0, HEIGHT_M + 0.0003);
  const studs = studGeometry();
  const group = new THREE.Group();
  group.add(
    new THREE.Mesh(lower, materials.lower),
    new THREE.Mesh(gap, materials.dark),
    new THREE.Mesh(shell, materials.top),
    new THREE.Mesh(hole, materials.dark),
    new THREE.Mesh(rim, materials.lower),
    new THREE.Mesh(studs, materials.top),
  );
  const owned = [lower, gap, shell, hole, rim, studs, ...Object.values(materials)];
  return { group, top: materials.top, dispose: () => owned.forEach((thing) => thing.dispose()) };
}

/**
 * The body seen from above; with notches where the wheels are.
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

/** @param {THREE.Shape} shape @param {number} bottom @param {number} top @param {number} bevel */
function extruded(shape, bottom, top, bevel) {
  const geometry = new THREE.ExtrudeGeometry(shape, {
    depth: top - bottom - 2 * bevel,
    bevelEnabled: bevel > 0,
    bevelThickness: bevel,
    bevelSize: bevel,
    bevelOffset: -bevel,
    bevelSegments: 2,
    curveSegments: 10,
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
