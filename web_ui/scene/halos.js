// The soft glow of lit lights: a spot before each, and the light of the shell on the ground.

import * as THREE from "three";

import { glow, opacityTexture } from "./glow.js";
import { Instances } from "./instances.js";
import { overlayMaterial } from "./materials.js";
import { LIGHTS } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const GLOW = 4.2; // size of the halo at full brightness, in radii
const BEFORE_M = 0.0009; // distance of the halo in front of its light
const STRENGTH = 0.62;
const GROUND = { radius: 0.105, x: 0.024, strength: 0.42 };
const UP = new THREE.Vector3(0, 0, 1);
const FULL = LIGHTS.map(({ color }) => new THREE.Color(color).multiplyScalar(STRENGTH));

/** @param {import("./parts.js").Light} light @param {number} radius */
function facing({ place, normal }, radius) {
  const direction = new THREE.Vector3(normal.x, normal.y, normal.z);
  return new THREE.Matrix4().compose(
    new THREE.Vector3(place.x, place.y, place.z).addScaledVector(direction, BEFORE_M),
    new THREE.Quaternion().setFromUnitVectors(UP, direction),
    new THREE.Vector3().setScalar(radius),
  );
}

/** @param {import("./robot_instances.js").Capacity} room */
export function createHalos({ robots }) {
  const texture = opacityTexture(64, (x, y) => Math.max(0, 1 - Math.hypot(x, y)) ** 2);
  const material = overlayMaterial({ map: texture, shines: true });
  const halos = new Instances(new THREE.PlaneGeometry(2, 2), material, { each: LIGHTS.length, robots });
  halos.mesh.renderOrder = 5;
  return {
    parts: [halos],
    isGlow: true,
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, { robot }, before) {
      if (before?.robot.leds === robot.leds) return;
      LIGHTS.forEach((light, index) => {
        const level = robot.leds[light.group]?.[light.index] ?? 0;
        halos.put(slot, index, level > 0 ? facing(light, light.radius * (1.4 + GLOW * Math.sqrt(level))) : null);
        halos.tint(slot, index, FULL[index]);
      });
    },
    dispose: () => texture.dispose(),
  };
}

/** The light of the shell on the ground around the robot. @param {import("./robot_instances.js").Capacity} room */
export function createGroundGlow({ robots }) {
  const texture = opacityTexture(64, (x, y) => Math.min(1, 1.5 * Math.max(0, 1 - Math.hypot(x, y)) ** 1.6));
  const material = overlayMaterial({ map: texture, shines: true });
  const glows = new Instances(new THREE.PlaneGeometry(2, 2), material, { each: 1, robots });
  glows.mesh.renderOrder = 1;
  const place = new THREE.Matrix4().makeScale(GROUND.radius, GROUND.radius, 1).setPosition(GROUND.x, 0, 0.0022);
  const color = new THREE.Color();
  return {
    parts: [glows],
    isGlow: true,
    isOnGround: true,
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, { robot }, before) {
      if (before?.robot.leds === robot.leds) return;
      const { color: lit, level } = glow(robot.leds.top);
      glows.put(slot, 0, level > 0 ? place : null);
      glows.tint(slot, 0, color.setRGB(lit[0], lit[1], lit[2]).multiplyScalar(GROUND.strength * level));
    },
    dispose: () => texture.dispose(),
  };
}
