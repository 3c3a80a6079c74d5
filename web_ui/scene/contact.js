// The shade on the ground around everything that stands on it: one mesh for a whole playground.

import * as THREE from "three";

import { MARKER } from "../state/markers.js";
import { overlayMaterial } from "./materials.js";

/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {[number, number]} Point */

const COLOR = new THREE.Color(0x3a2614);
const ABOVE_M = 0.0025; // above every layer of paint
const DARKEST = 0.4;
/** Width of the shade for a high solid; a low one has less, in proportion. */
const WIDE_M = 0.034;
const HIGH_M = 0.1;
/** How far the shade is moved away from the light, in widths. */
const MOVED = { x: 0.36, y: 0.2 };
const ROUND = 20;

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
function footprint({ ns, type, pose: { position, orientation }, scale }) {
  if (!ns.startsWith("solid/") || position.z - scale.z / 2 > 0.01) return null;
  const { x, y, z, w } = orientation;
  const yaw = Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
  /** @type {Point[]} */ let local;
  if (type === MARKER.CUBE) {
    const [halfX, halfY] = [scale.x / 2, scale.y / 2];
    local = [
      [-halfX, -halfY],
      [halfX, -halfY],
      [halfX, halfY],
      [-halfX, halfY],
    ];
  } else if (type === MARKER.CYLINDER) {
    local = Array.from({ length: ROUND }, (_, at) => {
      const angle = (2 * Math.PI * at) / ROUND;
      return /** @type {Point} */ ([(scale.x / 2) * Math.cos(angle), (scale.y / 2) * Math.sin(angle)]);
    });
  } else return null;
  const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
  return local.map(([px, py]) => [position.x + px * cos - py * sin, position.y + px * sin + py * cos]);
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
