// Several shapes of one colour each as one geometry with coloured corners, so that they are drawn at once.

import * as THREE from "three";
import { mergeGeometries, mergeVertices } from "three/addons/utils/BufferGeometryUtils.js";

/**
 * @param {readonly [THREE.BufferGeometry, number][]} shapes  with their colours; they are disposed
 * @returns {THREE.BufferGeometry}
 */
export function merged(shapes) {
  const parts = shapes.map(([shape, colour]) => {
    const part = shape.index === null ? shape.clone() : shape.toNonIndexed();
    part.deleteAttribute("uv");
    const { r, g, b } = new THREE.Color(colour);
    const { count } = part.attributes.position;
    const colours = new Float32Array(3 * count);
    for (let corner = 0; corner < count; corner++) colours.set([r, g, b], 3 * corner);
    part.setAttribute("color", new THREE.BufferAttribute(colours, 3));
    part.clearGroups();
    shape.dispose();
    return part;
  });
  const whole = mergeGeometries(parts);
  for (const part of parts) part.dispose();
  return mergeVertices(whole);
}
