// The color of a material that an RGB light shines through.

import * as THREE from "three";

/**
 * Color = levels divided by the largest, opacity = the largest (docs/spec/thymio-robot.md section 8.1).
 *
 * @param {THREE.Color} target
 * @param {THREE.Color} off
 * @param {readonly number[] | undefined} levels
 * @param {number} most  share of the light's color at full brightness
 */
export function glow(target, off, levels = [0, 0, 0], most) {
  const largest = Math.max(...levels);
  target.copy(off);
  if (largest <= 0) return;
  const [r, g, b] = levels.map((level) => level / largest);
  target.lerp(new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace), most * Math.min(1, 0.25 + 0.75 * largest));
}

/**
 * The texture of a round spot, opaque in its center.
 *
 * @param {number} size  pixels
 * @param {[number, number, number]} color  0…255
 * @param {(share: number) => number} opacity  opacity 0…1 as a function of 1 in the center to 0 at the edge
 */
export function spotTexture(size, color, opacity) {
  const data = new Uint8Array(size * size * 4);
  for (let row = 0; row < size; row++) {
    for (let column = 0; column < size; column++) {
      const distance = Math.hypot(row - size / 2 + 0.5, column - size / 2 + 0.5) / (size / 2);
      data.set([...color, 255 * opacity(Math.max(0, 1 - distance))], (row * size + column) * 4);
    }
  }
  const texture = new THREE.DataTexture(data, size, size);
  texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
