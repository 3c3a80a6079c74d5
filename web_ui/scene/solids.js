// How walls, boxes and posts look: cardboard or their own color, a little darker towards the foot.

import * as THREE from "three";

import { wallColor } from "./colors.js";
import { litMaterial } from "./materials.js";
import { MARKER } from "../state/markers.js";

/** @typedef {import("../state/markers.js").Marker} Marker */

const FOOT = 0.8;
const PERIOD_M = 0.015;
/** A box that is not thicker and not higher is a wall. */
const WALL = { thick: 0.035, high: 0.16 };
/** `aEdge` of corners that are not on a cut edge. */
const NO_EDGE = 9;

/** @param {Marker} marker */
function isWall({ type, scale }) {
  const thick = Math.min(scale.x, scale.y);
  return type === MARKER.CUBE && thick <= WALL.thick && scale.z <= WALL.high && Math.max(scale.x, scale.y) > 2 * thick;
}

/** @param {Marker} marker @param {THREE.BufferGeometry} geometry  in the marker's frame, already scaled */
export function solidMesh(marker, geometry) {
  const { color, type } = marker;
  const wall = isWall(marker);
  const shown = wall || type === MARKER.TRIANGLE_LIST ? wallColor(color) : new THREE.Color().setRGB(color.r, color.g, color.b);
  shadeFoot(geometry);
  if (wall) cutEdge(geometry, marker);
  const side = type === MARKER.TRIANGLE_LIST ? THREE.DoubleSide : THREE.FrontSide;
  return new THREE.Mesh(
    geometry,
    litMaterial({ color: shown, vertexColors: true, zigzag: wall, opacity: color.a, side }),
  );
}

/** Darker where less light arrives. @param {THREE.BufferGeometry} geometry */
function shadeFoot(geometry) {
  const { position } = geometry.attributes;
  geometry.computeBoundingBox();
  const { min, max } = /** @type {THREE.Box3} */ (geometry.boundingBox);
  const colors = new Float32Array(3 * position.count);
  for (let at = 0; at < position.count; at++) {
    const share = (position.getZ(at) - min.z) / Math.max(1e-6, max.z - min.z);
    colors.fill(FOOT + (1 - FOOT) * share, 3 * at, 3 * at + 3);
  }
  geometry.setAttribute("color", new THREE.BufferAttribute(colors, 3));
}

/** The top of a cardboard wall: x counts waves along it, y is the place across, from -0.5 to 0.5. @param {THREE.BufferGeometry} geometry @param {Marker} marker */
function cutEdge(geometry, { scale }) {
  const { position, normal } = geometry.attributes;
  const edges = new Float32Array(2 * position.count);
  const isAlongX = scale.x >= scale.y;
  for (let at = 0; at < position.count; at++) {
    const [x, y] = [position.getX(at), position.getY(at)];
    const isTop = normal.getZ(at) > 0.5;
    const [along, across] = isAlongX ? [x, y / scale.y] : [y, x / scale.x];
    edges.set(isTop ? [along / PERIOD_M, across] : [0, NO_EDGE], 2 * at);
  }
  geometry.setAttribute("aEdge", new THREE.BufferAttribute(edges, 2));
}
