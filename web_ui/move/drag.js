// Pointer control for moving bodies: in move mode, or with Shift (which also makes button presses sticky). These
// handlers run before those of buttons and camera.

/** @typedef {import("./drag_controller.js").DragController} DragController */

/**
 * @param {object} options
 * @param {HTMLElement} options.element
 * @param {(event: PointerEvent) => import("./drag_controller.js").Ray | null} options.rayOf
 * @param {DragController} options.dragController
 * @param {(event: PointerEvent) => boolean} options.isButton
 */
export function watchDrags({ element, rayOf, dragController, isButton }) {
  /** @type {number | null} */ let pointer = null;
  /** @param {PointerEvent} event */
  const isOurs = (event) => {
    if (event.pointerId !== pointer) return false;
    event.stopImmediatePropagation();
    return true;
  };
  element.addEventListener(
    "pointerdown",
    (event) => {
      const ray = pointer === null && event.button === 0 ? rayOf(event) : null;
      if (ray === null || !dragController.grab(ray, dragController.mode || (event.shiftKey && !isButton(event)))) return;
      pointer = event.pointerId;
      element.setPointerCapture(pointer);
      event.stopImmediatePropagation();
    },
    { capture: true },
  );
  element.addEventListener(
    "pointermove",
    (event) => {
      const ray = isOurs(event) ? rayOf(event) : null;
      if (ray !== null) dragController.drag(ray);
    },
    { capture: true },
  );
  for (const name of /** @type {const} */ (["pointerup", "pointercancel"])) {
    element.addEventListener(
      name,
      (event) => {
        if (!isOurs(event)) return;
        pointer = null;
        if (name === "pointerup") void dragController.drop();
        else dragController.cancel();
      },
      { capture: true },
    );
  }
}
