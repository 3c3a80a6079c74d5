// The grip between stage and workspace: dragged, or moved by arrow keys; a double click gives the usual width.

import { setAttribute } from "../ui/dom.js";
import { workRange } from "../ui/layout.js";

const STEP_PX = 16;

/**
 * @param {HTMLElement} grip
 * @param {import("./workspace.js").Workspace} workspace
 * @param {import("./frame.js").Frame} frame
 */
export function watchGrip(grip, workspace, frame) {
  grip.addEventListener("pointerdown", (event) => {
    if (event.button === 0) grip.setPointerCapture(event.pointerId);
  });
  grip.addEventListener("pointermove", (event) => {
    if (grip.hasPointerCapture(event.pointerId)) set(window.innerWidth - event.clientX);
  });
  grip.addEventListener("dblclick", () => workspace.setWidth(null));
  grip.addEventListener("keydown", (event) => {
    const { least, most } = workRange(window.innerWidth);
    const now = frame.workWidth;
    const wanted = { ArrowLeft: now + STEP_PX, ArrowRight: now - STEP_PX, Home: least, End: most }[event.key];
    if (wanted === undefined) return;
    event.preventDefault();
    set(wanted);
  });

  /** @param {number} width */
  function set(width) {
    const { least, most } = workRange(window.innerWidth);
    workspace.setWidth(Math.max(least, Math.min(width, most)));
  }

  const show = () => {
    const { least, most } = workRange(window.innerWidth);
    setAttribute(grip, "aria-valuemin", String(least));
    setAttribute(grip, "aria-valuemax", String(most));
    setAttribute(grip, "aria-valuenow", String(frame.workWidth));
  };
  frame.subscribe(show);
  show();
}
