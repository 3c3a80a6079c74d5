// The shade on the ground around everything that stands on it: one mesh for a whole playground.

import * as THREE from "three";

import { bodyOf, placed } from "../move/placed_bodies.js";
import { MARKER } from "../state/markers.js";
import { overlayMaterial } from "./materials.js";

/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("../move/placed_bodies.js").Point} Point */

const COLOR = new THREE.Color(0x3a2614);
const ABOVE_M = 0.0025; // above every layer of paint
const DARKEST = 0.4;
/** Width of the shade for a high solid; a low one has less, in proportion. */
const WIDE_M = 0.034;
const HIGH_M = 0.1;
/** How far the shade is moved away from the light, in widths. */
const MOVED = { x: 0.36, y: 0.2 };

export class ContactShade {
  constructor() {
    const material = overlayMaterial({ vertexColors: true, color: COLOR });
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.renderOrder = 1;
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** @param {Iterable<Marker>} markers */
  update(markers) {
    /** @type {number[]} */ const corners = [];
    /** @type {number[]} */ const opacities = [];
    for (const marker of markers) {
      const ring = footprint(marker);
      if (ring === null) continue;
      const high = marker.scale.z;
      const wide = WIDE_M * Math.min(1, high / HIGH_M);
      const outer = grown(ring, wide).map(([x, y]) => /** @type {Point} */ ([x + MOVED.x * wide, y + MOVED.y * wide]));
      ring.forEach((from, at) => {
        const next = (at + 1) % ring.length;
        for (const [[x, y], opacity] of /** @type {[Point, number][]} */ ([
          [from, DARKEST],
          [outer[at], 0],
          [outer[next], 0],
          [from, DARKEST],
          [outer[next], 0],
          [ring[next], DARKEST],
        ])) {
          corners.push(x, y, ABOVE_M);
          opacities.push(opacity, opacity, opacity);
        }
      });
    }
    const { geometry } = this.mesh;
    geometry.dispose();
    geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(opacities, 3));
    this.mesh.visible = corners.length > 0;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** The outline of an upright solid on the ground, counter-clockwise; null for others. @param {Marker} marker @returns {Point[] | null} */
function footprint(marker) {
  const { ns, type, pose, scale } = marker;
  if (!ns.startsWith("solid/") || pose.position.z - scale.z / 2 > 0.01) return null;
  if (type !== MARKER.CUBE && type !== MARKER.CYLINDER) return null;
  const body = bodyOf(marker);
  return placed(body.outline, body.pose)[0];
}

/** A convex outline, moved outward by a width. @param {Point[]} ring @param {number} wide @returns {Point[]} */
function grown(ring, wide) {
  return ring.map(([x, y], at) => {
    const [beforeX, beforeY] = ring[(at + ring.length - 1) % ring.length];
    const [nextX, nextY] = ring[(at + 1) % ring.length];
    const [one, other] = [
      [y - beforeY, beforeX - x],
      [nextY - y, x - nextX],
    ].map(([nx, ny]) => [nx / (Math.hypot(nx, ny) || 1), ny / (Math.hypot(nx, ny) || 1)]);
    const [sumX, sumY] = [one[0] + other[0], one[1] + other[1]];
    const share = wide / Math.max(0.3, (sumX * sumX + sumY * sumY) / 2);
    return [x + sumX * share, y + sumY * share];
  });
}
