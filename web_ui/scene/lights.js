// The light of every world: from the upper left, warm; by day, and in the evening for the dark theme. The values are
// shared by all materials (materials.js), so a change of theme changes numbers only.

import * as THREE from "three";

import "./colors.js";

/** @typedef {"light" | "dark"} Theme */

export const LIGHT = {
  /** Unit vector to the light. */
  uSun: { value: new THREE.Vector3(-0.46, -0.4, 0.8).normalize() },
  uSky: { value: new THREE.Color().setRGB(0.66, 0.655, 0.645) },
  uGround: { value: new THREE.Color().setRGB(0.5, 0.455, 0.41) },
  uKey: { value: new THREE.Color().setRGB(0.4, 0.392, 0.372) },
  /** Everything but lights is multiplied by it. */
  uDim: { value: new THREE.Color(0xffffff) },
  /** The brightness of lights. */
  uLamps: { value: 1 },
};

const THEMES = /** @type {Record<Theme, { dim: [number, number, number], lamps: number }>} */ ({
  light: { dim: [1, 1, 1], lamps: 1 },
  dark: { dim: [0.66, 0.625, 0.58], lamps: 1.3 },
});

/** @param {Theme} theme */
export function lightAs(theme) {
  const { dim, lamps } = THEMES[theme];
  LIGHT.uDim.value.setRGB(...dim);
  LIGHT.uLamps.value = lamps;
}
