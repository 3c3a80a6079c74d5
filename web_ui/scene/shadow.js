// The shadow of a robot: dark where it touches the ground, and a softer one away from the light. Both are the blurred
// outline of the robot; they grow pale and wide when it is lifted.

import * as THREE from "three";

import { opacityTexture } from "./glow.js";
import { HULLS, outlineColumns } from "./hull.js";
import { Instances, placeOf } from "./instances.js";
import { overlayMaterial } from "./materials.js";

const SIZE_M = 0.17;
const CENTER_X_M = 0.024;
const BLUR_M = 0.0065;
const ABOVE_M = 0.0026; // above every layer of paint
const CONTACT = 0.5;
const SOFT = { opacity: 0.34, scale: 1.1, right: 0.011, away: 0.005 };
const LIFTED = { wider: 0.08, gone: 0.12 };
const COLOR = new THREE.Color(0x3a2614);

/** @param {import("./robot_instances.js").Capacity} room */
export function createShadow({ robots }) {
  const texture = opacityTexture(64, (x, y) => {
    const inside = depthIn((x * SIZE_M) / 2 + CENTER_X_M, (y * SIZE_M) / 2);
    const share = Math.min(1, Math.max(0, inside / (2 * BLUR_M) + 0.5));
    return share * share * (3 - 2 * share);
  });
  const material = overlayMaterial({ map: texture, color: COLOR });
  const shadow = new Instances(new THREE.PlaneGeometry(SIZE_M, SIZE_M), material, { each: 2, robots });
  shadow.mesh.renderOrder = 2;
  const opacity = new THREE.Color();
  return {
    parts: [shadow],
    isOnGround: true,
    show() {},
    /** @param {number} slot @param {THREE.Matrix4} frame  of the robot */
    follow(slot, frame) {
      const height = Math.max(0, frame.elements[14]);
      const yaw = Math.atan2(frame.elements[1], frame.elements[0]);
      const [cos, sin] = [Math.cos(yaw), Math.sin(yaw)];
      const wide = 1 + height / LIFTED.wider;
      const strength = Math.max(0, 1 - height / LIFTED.gone);
      const [right, away] = [SOFT.right + height, SOFT.away + height / 2];
      const aside = { x: right * cos + away * sin, y: away * cos - right * sin };
      const place = (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ scale) =>
        placeOf({ x: CENTER_X_M + x, y, z: ABOVE_M }).scale(new THREE.Vector3(scale, scale, 1));
      shadow.put(slot, 0, place(0, 0, wide));
      shadow.put(slot, 1, place(aside.x, aside.y, wide * SOFT.scale));
      shadow.tint(slot, 0, opacity.setScalar(CONTACT * strength));
      shadow.tint(slot, 1, opacity.setScalar(SOFT.opacity * strength));
    },
    dispose: () => texture.dispose(),
  };
}

const OUTLINE = outlineColumns(HULLS.outline);

/** How far a place is inside of the robot's outline, in meters; negative outside. @param {number} x @param {number} y */
function depthIn(x, y) {
  let nearest = Infinity;
  let isInside = true;
  OUTLINE.forEach((from, at) => {
    const to = OUTLINE[(at + 1) % OUTLINE.length];
    const [edgeX, edgeY] = [to.x - from.x, to.y - from.y];
    const long = edgeX * edgeX + edgeY * edgeY;
    if (long < 1e-12) return;
    const share = Math.min(1, Math.max(0, ((x - from.x) * edgeX + (y - from.y) * edgeY) / long));
    nearest = Math.min(nearest, Math.hypot(x - from.x - share * edgeX, y - from.y - share * edgeY));
    if (edgeX * (y - from.y) - edgeY * (x - from.x) < 0) isInside = false; // the outline is convex
  });
  return isInside ? nearest : -nearest;
}
