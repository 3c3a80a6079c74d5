// Pointer control of the robots' buttons: hover and press, several at once.
// Handlers only record events; pointers that miss all buttons are left to the camera.

import * as THREE from "three";

import { onShiftRelease } from "../ui/sticky_press.js";

/** @typedef {{ robot: string, button: string }} Target */

/**
 * @param {object} options
 * @param {HTMLElement} options.element
 * @param {() => THREE.Camera} options.camera
 * @param {() => THREE.Object3D[]} options.targets
 * @param {(target: Target, pressed: boolean) => void} options.press
 * @param {(target: Target | null) => void} options.hover
 * @returns {{ isAt: (event: PointerEvent) => boolean }}  whether there is a button
 */
export function watchPointer({ element, camera, targets, press, hover }) {
  const caster = new THREE.Raycaster();
  /** @type {Map<number, Target>} */ const held = new Map();
  /** @type {Target[]} pressed until Shift is released */ let shiftHeld = [];

  /** @param {PointerEvent} event @returns {Target | null} */
  const targetAt = (event) => {
    const { left, top, width, height } = element.getBoundingClientRect();
    const place = new THREE.Vector2(((event.clientX - left) / width) * 2 - 1, 1 - ((event.clientY - top) / height) * 2);
    caster.setFromCamera(place, camera());
    const [hit] = caster.intersectObjects(targets(), false);
    return hit === undefined ? null : { robot: hit.object.userData.robot, button: hit.object.userData.button };
  };
  /** @param {PointerEvent} event */
  const release = (event) => {
    const target = held.get(event.pointerId);
    if (target === undefined) return;
    held.delete(event.pointerId);
    if (event.type === "pointerup" && event.shiftKey) keep(target);
    else press(target, false);
    event.stopImmediatePropagation();
  };
  /** @param {Target} target */
  const keep = (target) => {
    if (shiftHeld.length === 0) onShiftRelease(() => shiftHeld.splice(0).forEach((each) => press(each, false)));
    shiftHeld.push(target);
  };

  // Registered for the capture phase, so that the camera's handlers do not see a press on a button.
  element.addEventListener(
    "pointerdown",
    (event) => {
      const target = event.button === 0 ? targetAt(event) : null;
      if (target === null) return;
      event.stopImmediatePropagation();
      element.setPointerCapture(event.pointerId);
      held.set(event.pointerId, target);
      shiftHeld = shiftHeld.filter(({ robot, button }) => robot !== target.robot || button !== target.button);
      press(target, true);
    },
    { capture: true },
  );
  element.addEventListener("pointerup", release, { capture: true });
  element.addEventListener("pointercancel", release, { capture: true });
  element.addEventListener("pointermove", (event) => {
    if (event.pointerType === "mouse" && event.buttons === 0) hover(targetAt(event));
  });
  element.addEventListener("pointerleave", () => hover(null));
  return { isAt: (event) => targetAt(event) !== null };
}
