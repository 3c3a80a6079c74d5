// Keys while one builds. They work on the view only, so that writing in fields acts on nothing else; undo and redo
// also from the buttons around it.

import { plainKey } from "../input/keyboard.js";

/** @typedef {import("./creator_model.js").CreatorModel} CreatorModel */

const STEPS = /** @type {Record<string, [number, number]>} */ ({
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
});
/** Counter-clockwise, clockwise: as where things are moved while the world runs. */
const TURNS = /** @type {Record<string, number>} */ ({ ",": 1, "<": 1, ".": -1, ">": -1, r: 1 });
/** What the camera keeps. */
const CAMERA_KEYS = ["+", "=", "-", "Home", "t"];

/**
 * @param {object} options
 * @param {HTMLElement} options.stage
 * @param {HTMLElement} options.canvas
 * @param {readonly HTMLElement[]} options.around   where undo and redo work too
 * @param {CreatorModel} options.model
 * @param {() => void} options.editFields   go on in the form
 * @returns {() => void}  ends it
 */
export function watchBuildingKeys({ stage, canvas, around, model, editFields }) {
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
      event.stopPropagation(); // no robot's button is pressed, and Escape stops none
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
        else if (event.key === "Escape" && model.cancel()) event.stopPropagation(); // and no robot is stopped
      },
      { signal },
    );
  }
  return () => ending.abort();
}

/**
 * Shift and arrows turn the camera while nothing is in hand or selected.
 *
 * @param {CreatorModel} model
 * @param {KeyboardEvent} event
 */
function isCameraTurn({ placing, selected }, { key, shiftKey }) {
  return shiftKey && key in STEPS && placing === null && selected === null;
}

/** Undo and redo; whether it was one. @param {CreatorModel} model @param {KeyboardEvent} event */
function travel(model, { key, ctrlKey, metaKey, shiftKey }) {
  if (!ctrlKey && !metaKey) return false;
  const letter = key.toLowerCase();
  if (letter === "z" && !shiftKey) model.undo();
  else if (letter === "y" || letter === "z") model.redo();
  else return false;
  return true;
}

/**
 * Whether the key did something.
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
    model.duplicate();
    return true;
  }
  if (key in STEPS) model.nudge(...STEPS[key], { far: shiftKey, fine: altKey });
  else if (key in TURNS) model.turn(key === "r" && shiftKey ? -1 : TURNS[key], altKey);
  else if (key === "Escape") model.cancel();
  else if (key === " " && placing !== null) placing.put();
  else if (key === "Enter") {
    if (placing === null) editFields();
    else if (placing.kind === "track" && placing.points.length > 1) placing.finish();
    else placing.put();
  } else if (key === "Backspace" && placing !== null) placing.undoPoint();
  else if (key === "Delete" || key === "Backspace") model.remove();
  else if (key === "n") model.selectNext(shiftKey ? -1 : 1);
  else if (key === "PageUp") model.raise(1);
  else if (key === "PageDown") model.raise(-1);
  else return false;
  return true;
}
