// Merges several shapes, each of one color, into one geometry with vertex colors, for a single draw call.

import * as THREE from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";

import "./colors.js";

/**
 * @param {readonly [THREE.BufferGeometry, number][]} shapes  with their colors; they are disposed
 * @returns {THREE.BufferGeometry}
 */
export function merged(shapes) {
  const parts = shapes.map(([shape, color]) => {
    const part = shape.index === null ? shape.clone() : shape.toNonIndexed();
    part.deleteAttribute("uv");
    const { r, g, b } = new THREE.Color(color);
    const { count } = part.attributes.position;
    const colors = new Float32Array(3 * count);
    for (let corner = 0; corner < count; corner++) colors.set([r, g, b], 3 * corner);
    part.setAttribute("color", new THREE.BufferAttribute(colors, 3));
    part.clearGroups();
    shape.dispose();
    return part;
  });
  const whole = mergeGeometries(parts);
  for (const part of parts) part.dispose();
  return mergeVertices(whole);
}
