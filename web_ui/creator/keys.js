// Keyboard control of the creator. Keys act only while the view has the focus, so that typing in fields is safe;
// undo and redo also work from the surrounding buttons.

import { plainKey } from "../input/keyboard.js";

/** @typedef {import("./creator_model.js").CreatorModel} CreatorModel */

const STEPS = /** @type {Record<string, [number, number]>} */ ({
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
});
/** Counter-clockwise and clockwise: the same keys as for moving objects in the running world. */
const TURNS = /** @type {Record<string, number>} */ ({ ",": 1, "<": 1, ".": -1, ">": -1, r: 1 });
/** Keys that the camera keeps. */
const CAMERA_KEYS = ["+", "=", "-", "Home", "t"];

/**
 * @param {object} options
 * @param {HTMLElement} options.stage
 * @param {HTMLElement} options.canvas
 * @param {readonly HTMLElement[]} options.around   elements where undo and redo work too
 * @param {CreatorModel} options.model
 * @param {() => void} options.editFields   moves the focus to the form
 * @returns {() => void}  removes the listeners
 */
export function watchCreatorKeys({ stage, canvas, around, model, editFields }) {
  const ending = new AbortController();
  const { signal } = ending;
  let shiftAlone = false;

  stage.addEventListener(
    "keydown",
    (event) => {
      if (event.target !== canvas) return;
      shiftAlone = event.key === "Shift" && !event.repeat;
      const isTheirs = CAMERA_KEYS.includes(plainKey(event)) || event.key === "Tab" || isCameraTurn(model, event);
      if (isTheirs && !event.ctrlKey && !event.metaKey) return;
      event.stopPropagation(); // do not press robot buttons, and do not stop robots by Escape
      if (act(model, event, editFields)) event.preventDefault();
    },
    { capture: true, signal },
  );
  stage.addEventListener(
    "keyup",
    (event) => {
      if (event.target === canvas && event.key === "Shift" && shiftAlone) model.toggleCamera();
      shiftAlone = false;
    },
    { capture: true, signal },
  );
  for (const name of ["pointerdown", "wheel"])
    stage.addEventListener(name, () => (shiftAlone = false), { capture: true, signal });
  for (const element of around) {
    element.addEventListener(
      "keydown",
      (event) => {
        const isText = event.target instanceof HTMLInputElement && !["checkbox", "color"].includes(event.target.type);
        if (event.target === canvas || isText || event.target instanceof HTMLTextAreaElement) return;
        if (travel(model, event)) event.preventDefault();
        else if (event.key === "Escape" && model.cancel()) event.stopPropagation(); // do not stop the robots
      },
      { signal },
    );
  }
  return () => ending.abort();
}

/**
 * Shift and arrows turn the camera while no item is placed or selected.
 *
 * @param {CreatorModel} model
 * @param {KeyboardEvent} event
 */
function isCameraTurn({ placing, selected }, { key, shiftKey }) {
  return shiftKey && key in STEPS && placing === null && selected === null;
}

/**
 * Handle undo and redo; returns whether the key was one of them.
 *
 * @param {CreatorModel} model
 * @param {KeyboardEvent} event
 */
function travel(model, { key, ctrlKey, metaKey, shiftKey }) {
  if (!ctrlKey && !metaKey) return false;
  const letter = key.toLowerCase();
  if (letter === "z" && !shiftKey) model.undo();
  else if (letter === "y" || letter === "z") model.redo();
  else return false;
  return true;
}

/**
 * Returns whether the key had an effect.
 *
 * @param {CreatorModel} model
 * @param {KeyboardEvent} event
 * @param {() => void} editFields
 */
function act(model, event, editFields) {
  const { shiftKey, altKey, ctrlKey, metaKey } = event;
  const key = plainKey(event);
  const { placing } = model;
  if (travel(model, event)) return true;
  if (ctrlKey || metaKey) {
    if (key !== "d") return false;
    model.selecting.duplicate();
    return true;
  }
  if (key in STEPS) model.nudge(...STEPS[key], { far: shiftKey, fine: altKey });
  else if (key in TURNS) model.turn(key === "r" && shiftKey ? -1 : TURNS[key], altKey);
  else if (key === "Escape") model.cancel();
  else if (key === " " && placing !== null) placing.put();
  else if (key === "Enter") {
    if (placing === null) editFields();
    else if (placing.pathKey !== undefined && placing.points.length > 1) placing.finish();
    else placing.put();
  } else if (key === "Backspace" && placing !== null) placing.undoPoint();
  else if (key === "Delete" || key === "Backspace") model.selecting.remove();
  else if (key === "n") model.selectNext(shiftKey ? -1 : 1);
  else if (key === "PageUp") model.selecting.raise(1);
  else if (key === "PageDown") model.selecting.raise(-1);
  else return false;
  return true;
}
