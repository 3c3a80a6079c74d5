// The colors of the scene. They are values of the display, so three.js must not convert them: this module switches the
// conversion off, and every module with a color constant imports it.

import * as THREE from "three";

THREE.ColorManagement.enabled = false;

export const PAPER = new THREE.Color(0xf3eee3);
export const TAPE = new THREE.Color(0x26221f);
/** Wood, where its grain is not drawn. */
export const DESK = new THREE.Color(0xd8b184);
/** Cardboard that was declared black, and white. */
const KRAFT = { dark: new THREE.Color(0x9d7d57), light: new THREE.Color(0xedc68f) };
/** Below this saturation the declared color of a wall is only a shade of cardboard. */
const COLORED = 0.25;

/**
 * Color of the floor, of paint and of pen lines as drawn: black is tape, white is paper, and the order of all grays
 * stays, so a place looks darker exactly where the ground sensors measure less.
 *
 * @param {{ r: number, g: number, b: number }} declared  0…1
 * @param {THREE.Color} [target]
 */
export function groundColor({ r, g, b }, target = new THREE.Color()) {
  return target.setRGB(
    TAPE.r + (PAPER.r - TAPE.r) * r,
    TAPE.g + (PAPER.g - TAPE.g) * g,
    TAPE.b + (PAPER.b - TAPE.b) * b,
  );
}

/** Color of a wall: gray ones are cardboard. @param {{ r: number, g: number, b: number }} declared  0…1 */
export function wallColor({ r, g, b }) {
  const most = Math.max(r, g, b);
  if (most > 0 && (most - Math.min(r, g, b)) / most > COLORED) return new THREE.Color().setRGB(r, g, b);
  return KRAFT.dark.clone().lerp(KRAFT.light, (r + g + b) / 3);
}
