// All lights: a disc with a soft glow each, and the two colored strips; the top light colors the shell (body.js).

import * as THREE from "three";

import { glow, spotTexture } from "./glow.js";
import { Instances, placeOf } from "./instances.js";
import { LIGHTS, RGB_LIGHTS } from "./parts.js";

/** @typedef {import("./robot_instances.js").Look} Look */

const OFF = new THREE.Color(0xc3cad2);
const STRIP_OFF = new THREE.Color(0xcfd6dd);
const STRIPS = /** @type {const} */ (["bottom_left", "bottom_right"]);
const GLOW = 4.2; // size of the halo at full brightness, in radii
const BEFORE_M = 0.0004; // distance of the halo in front of its disc
const FAR = 2.5; // size of a light on a distant robot, in radii: without halo, and only while it is lit
/**
 * Lights that are drawn on distant robots. The others are on the sides and under the front, and some are always lit.
 */
const SEEN_FROM_FAR = new Set(["circle", "buttons", "proximity"]);

const UP = new THREE.Vector3(0, 0, 1);

/**
 * A disc of this size at a light.
 *
 * @param {import("./parts.js").Light} light
 * @param {number} radius
 * @param {number} before  meters
 */
function facing({ place, normal }, radius, before) {
  const direction = new THREE.Vector3(normal.x, normal.y, normal.z);
  return new THREE.Matrix4().compose(
    new THREE.Vector3(place.x, place.y, place.z).addScaledVector(direction, before),
    new THREE.Quaternion().setFromUnitVectors(UP, direction),
    new THREE.Vector3().setScalar(radius),
  );
}

/** @param {import("./robot_instances.js").Capacity} room */
export function createLeds({ robots, fine }) {
  const each = LIGHTS.length;
  const texture = spotTexture(64, [255, 255, 255], (share) => share ** 2);
  const halo = new THREE.MeshBasicMaterial({ map: texture, transparent: true, depthWrite: false, opacity: 0.75 });
  const discs = new Instances(new THREE.CircleGeometry(1, fine ? 14 : 5), new THREE.MeshBasicMaterial(), { each, robots });
  const halos = new Instances(new THREE.PlaneGeometry(2, 2), halo, { each, robots });
  halos.mesh.renderOrder = 2;
  const strip = new THREE.BoxGeometry(0.022, 0.0016, 0.004);
  const strips = new Instances(strip, new THREE.MeshBasicMaterial(), { each: STRIPS.length, robots });
  const places = LIGHTS.map((light) => facing(light, light.radius * (fine ? 1 : FAR), 0));
  const stripPlaces = STRIPS.map((name) => placeOf(RGB_LIGHTS[name]));
  const full = LIGHTS.map(({ color }) => new THREE.Color(color));
  const color = new THREE.Color();
  return {
    parts: [discs, halos, strips],
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, { robot }, before) {
      if (before?.robot.leds === robot.leds) return;
      LIGHTS.forEach((light, index) => {
        const level = robot.leds[light.group]?.[light.index] ?? 0;
        const size = light.radius * (1.4 + GLOW * Math.sqrt(level));
        const shown = fine || (level > 0 && SEEN_FROM_FAR.has(light.group));
        discs.put(slot, index, shown ? places[index] : null);
        discs.tint(slot, index, color.copy(OFF).lerp(full[index], Math.sqrt(level)));
        halos.put(slot, index, fine && level > 0 ? facing(light, size, BEFORE_M) : null);
        halos.tint(slot, index, full[index]);
      });
      STRIPS.forEach((name, index) => {
        strips.put(slot, index, fine || robot.leds[name]?.some((level) => level > 0) ? stripPlaces[index] : null);
        glow(color, STRIP_OFF, robot.leds[name], 1);
        strips.tint(slot, index, color);
      });
    },
    dispose: () => texture.dispose(),
  };
}
