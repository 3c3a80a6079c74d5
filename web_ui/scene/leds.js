// All lights: one instanced disc each with a soft glow, and the three coloured ones on the shell.

import * as THREE from "three";

import { LIGHTS, RGB_LIGHTS } from "./parts.js";

/** @typedef {import("../state/robot.js").Robot} Robot */

const OFF = new THREE.Color(0xc3cad2);
const SHELL = new THREE.Color(0xf7f8fa);
const STRIP_OFF = new THREE.Color(0xcfd6dd);
const GLOW = 4.2; // size of the halo of a full light, in radii

/** @param {THREE.MeshLambertMaterial} shell  the top's material, which the top light tints */
export function createLeds(shell) {
  const disc = new THREE.CircleGeometry(1, 14);
  const square = new THREE.PlaneGeometry(2, 2);
  const plain = new THREE.MeshBasicMaterial({ color: 0xffffff });
  const texture = glowTexture();
  const halo = new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false, opacity: 0.75 });
  const discs = new THREE.InstancedMesh(disc, plain, LIGHTS.length);
  const halos = new THREE.InstancedMesh(square, halo, LIGHTS.length);
  halos.renderOrder = 2;
  discs.frustumCulled = halos.frustumCulled = false;

  const strip = new THREE.BoxGeometry(0.022, 0.0016, 0.004);
  const strips = /** @type {const} */ (["bottom_left", "bottom_right"]).map((group) => {
    const material = new THREE.MeshBasicMaterial({ color: STRIP_OFF });
    const mesh = new THREE.Mesh(strip, material);
    const { x, y, z } = RGB_LIGHTS[group];
    mesh.position.set(x, y, z);
    return { group, mesh, material };
  });
  const group = new THREE.Group();
  group.add(discs, halos, ...strips.map(({ mesh }) => mesh));

  const turns = LIGHTS.map(({ normal }) =>
    new THREE.Quaternion().setFromUnitVectors(
      new THREE.Vector3(0, 0, 1),
      new THREE.Vector3(normal.x, normal.y, normal.z),
    ),
  );
  const matrix = new THREE.Matrix4();
  const place = new THREE.Vector3();
  const size = new THREE.Vector3();
  const colour = new THREE.Color();
  /** @type {Robot["leds"] | null} */ let shown = null;

  /** @param {number} index @param {number} level */
  const light = (index, level) => {
    const { place: at, normal, radius, colour: full } = LIGHTS[index];
    place.set(at.x, at.y, at.z);
    matrix.compose(place, turns[index], size.setScalar(radius));
    discs.setMatrixAt(index, matrix);
    colour.set(full);
    halos.setColorAt(index, colour);
    discs.setColorAt(index, colour.copy(OFF).lerp(new THREE.Color(full), Math.sqrt(level)));
    place.addScaledVector(new THREE.Vector3(normal.x, normal.y, normal.z), 0.0004);
    matrix.compose(place, turns[index], size.setScalar(level > 0 ? radius * (1.4 + GLOW * Math.sqrt(level)) : 0));
    halos.setMatrixAt(index, matrix);
  };

  const owned = [disc, square, plain, texture, halo, strip, ...strips.map(({ material }) => material)];
  return {
    group,
    /** @param {Robot} robot */
    update(robot) {
      if (shown === robot.leds) return;
      shown = robot.leds;
      LIGHTS.forEach(({ group: name, index }, number) => light(number, robot.leds[name]?.[index] ?? 0));
      for (const mesh of [discs, halos]) {
        mesh.instanceMatrix.needsUpdate = true;
        if (mesh.instanceColor !== null) mesh.instanceColor.needsUpdate = true;
      }
      tint(shell.color, SHELL, robot.leds.top, 0.72);
      shell.emissive.copy(shell.color).multiplyScalar(0.12 * Math.max(0, ...(robot.leds.top ?? [0])));
      for (const { group: name, material } of strips) tint(material.color, STRIP_OFF, robot.leds[name], 1);
    },
    dispose: () => {
      discs.dispose();
      halos.dispose();
      owned.forEach((thing) => thing.dispose());
    },
  };
}

/**
 * Colour = levels divided by the largest, opacity = the largest (thymio-robot.md section 8.1).
 *
 * @param {THREE.Color} target
 * @param {THREE.Color} off
 * @param {number[] | undefined} levels
 * @param {number} most  share of the light's colour when full
 */
function tint(target, off, levels = [0, 0, 0], most) {
  const largest = Math.max(...levels);
  target.copy(off);
  if (largest <= 0) return;
  const [r, g, b] = levels.map((level) => level / largest);
  target.lerp(new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace), most * Math.min(1, 0.25 + 0.75 * largest));
}

function glowTexture() {
  const size = 64;
  const data = new Uint8Array(size * size * 4);
  for (let row = 0; row < size; row++) {
    for (let column = 0; column < size; column++) {
      const distance = Math.hypot(row - size / 2 + 0.5, column - size / 2 + 0.5) / (size / 2);
      data.set([255, 255, 255, 255 * Math.max(0, 1 - distance) ** 2], (row * size + column) * 4);
    }
  }
  const texture = new THREE.DataTexture(data, size, size);
  texture.magFilter = THREE.LinearFilter;
  texture.needsUpdate = true;
  return texture;
}
