// Pointer and wheel control of the creator. Handlers only record events and request a frame; `flush` applies them once
// per frame, however many moves arrived. They run before the camera's handlers, which get everything that is left.

import { atHeight } from "../move/placed_bodies.js";
import { WheelSteps } from "./wheel.js";

/** @typedef {import("./creator_model.js").CreatorModel} CreatorModel */
/** @typedef {{ clientX: number, clientY: number, altKey: boolean }} PointerPosition */

/** A pointer released within this distance has clicked. */
const CLICK_PX = 6;

/**
 * @param {object} options
 * @param {HTMLElement} options.stage    element that contains the canvas
 * @param {HTMLElement} options.canvas
 * @param {CreatorModel} options.model
 * @param {import("../scene/index.js").SceneView} options.scene
 * @returns {{ flush: () => void, destroy: () => void }}
 */
export function watchCreatorPointer({ stage, canvas, model, scene }) {
  const ending = new AbortController();
  /** @type {PointerPosition | null} */ let latest = null;
  /** @type {{ id: number, x: number, y: number, isDrag: boolean, click: boolean } | null} */ let down = null;
  const wheel = new WheelSteps();

  const flush = () => {
    model.pixel = scene.pixelSize;
    if (latest === null) return;
    const position = latest;
    latest = null;
    const ray = scene.projection.rayOf(position);
    const place = atHeight(ray, 0);
    model.pointer = place === null ? null : [place.x, place.y];
    if (down?.isDrag) model.selecting.drag(ray, position.altKey);
    else if (model.placing !== null && place !== null) {
      model.placing.hover([place.x, place.y], position.altKey);
      model.changed();
    }
  };
  /** @param {Event} event */
  const isHere = (event) => event.target === canvas;
  /** @param {keyof HTMLElementEventMap} name @param {(event: any) => void} handle */
  const on = (name, handle) =>
    stage.addEventListener(name, (event) => isHere(event) && handle(event), {
      capture: true,
      passive: false,
      signal: ending.signal,
    });

  on("pointerdown", (/** @type {PointerEvent} */ event) => {
    canvas.focus();
    if (down !== null) {
      down.click = false; // a second finger moves the camera
      return;
    }
    if (event.button !== 0) return;
    const isDrag = model.placing === null && model.selecting.grab(scene.projection.rayOf(event));
    down = { id: event.pointerId, x: event.clientX, y: event.clientY, isDrag, click: true };
    latest = event;
    if (isDrag) canvas.setPointerCapture(event.pointerId);
    if (isDrag || !model.cameraOn) event.stopPropagation();
    scene.invalidate();
  });
  on("pointermove", (/** @type {PointerEvent} */ event) => {
    if (down?.isDrag) event.stopPropagation();
    if (down !== null && Math.hypot(event.clientX - down.x, event.clientY - down.y) > CLICK_PX) down.click = false;
    if (down !== null && !down.isDrag && !down.click) return; // the camera turns
    latest = event;
    scene.invalidate();
  });
  on("pointerup", (/** @type {PointerEvent} */ event) => {
    if (event.pointerId !== down?.id) return;
    const { isDrag, click } = down;
    if (isDrag) event.stopPropagation();
    if (!isDrag && !click) {
      down = null;
      return;
    }
    latest = event;
    flush();
    down = null;
    if (isDrag) model.selecting.drop();
    else if (model.placing !== null) model.placing.put();
    else model.selecting.click(scene.projection.rayOf(event));
  });
  on("pointercancel", () => {
    down = null;
    model.selecting.cancel();
  });
  on("wheel", (/** @type {WheelEvent} */ event) => {
    const turns = model.placing !== null && !model.placing.isPath;
    if (!turns && model.cameraOn) return;
    event.stopPropagation();
    event.preventDefault();
    const steps = wheel.add(event);
    if (steps !== 0) model.turn(-steps, event.altKey);
  });
  return { flush, destroy: () => ending.abort() };
}
