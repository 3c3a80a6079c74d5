// Colors of lights, and textures of soft spots.

import * as THREE from "three";

import "./colors.js";

/**
 * The color of an RGB light at full brightness (levels divided by the largest), and its brightness
 * (docs/spec/thymio-robot.md section 8.1).
 *
 * @param {readonly number[] | undefined} levels
 * @returns {{ color: [number, number, number], level: number }}
 */
export function glow(levels = [0, 0, 0]) {
  const largest = Math.max(...levels);
  if (largest <= 0) return { color: [0, 0, 0], level: 0 };
  const [r, g, b] = levels.map((level) => level / largest);
  return { color: [r, g, b], level: Math.min(1, 0.25 + 0.75 * largest) };
}

/**
 * The texture of an opacity, in its red channel.
 *
 * @param {number} size  pixels
 * @param {(x: number, y: number) => number} opacity  0…1, as a function of the place: -1…1 across the texture
 */
export function opacityTexture(size, opacity) {
  const data = new Uint8Array(size * size * 4);
  for (let row = 0; row < size; row++) {
    for (let column = 0; column < size; column++) {
      const [x, y] = [column, row].map((at) => ((at + 0.5) / size) * 2 - 1);
      data.fill(255 * Math.min(1, Math.max(0, opacity(x, y))), 4 * (row * size + column), 4 * (row * size + column + 1));
    }
  }
  const texture = new THREE.DataTexture(data, size, size);
  texture.magFilter = texture.minFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
