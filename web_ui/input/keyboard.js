// Keyboard control of the 3D view: arrows and Enter press the robot's buttons; with Shift, arrows turn the camera; letters
// choose views and use the hands; Space pauses time.

import { handOfKey } from "./hand_keys.js";

/** @typedef {import("../scene/index.js").SceneView} SceneView */

const BUTTON_KEYS = /** @type {Record<string, string>} */ ({
  ArrowUp: "forward",
  ArrowDown: "backward",
  ArrowLeft: "left",
  ArrowRight: "right",
  Enter: "center",
});
const TURNS = /** @type {Record<string, [number, number]>} */ ({
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
});
const VIEW_KEYS = /** @type {Record<string, import("../scene/camera.js").ViewName>} */ ({
  Home: "home",
  t: "top",
  f: "follow",
  e: "eye",
});

/** Move mode: steps along x and y of the world, and turning steps. */
const MOVES = /** @type {Record<string, [number, number, number]>} */ ({
  ArrowUp: [0, 1, 0],
  ArrowDown: [0, -1, 0],
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  "<": [0, 0, 1],
  ",": [0, 0, 1],
  ">": [0, 0, -1],
  ".": [0, 0, -1],
});
const FAR = 5; // steps with Shift

/** The key, with letters in lower case regardless of Caps Lock and Shift. @param {KeyboardEvent} event */
export function plainKey({ key }) {
  return key.length === 1 ? key.toLowerCase() : key;
}

/**
 * @param {HTMLElement} element  element that must have the focus
 * @param {SceneView} scene
 * @param {import("../move/drag_controller.js").DragController} dragController
 * @param {(button: string, pressed: boolean) => void} press   presses a button of the addressed robots
 * @param {{ useHand?: (name: string) => void, pause?: () => void }} [others]
 */
export function watchKeyboard(element, scene, dragController, press, { useHand, pause } = {}) {
  /** @type {Set<string>} */ const pressedKeys = new Set();
  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { shiftKey, repeat } = event;
    const key = plainKey(event);
    const hand = handOfKey(key);
    if (key === "m") dragController.setMode(!dragController.mode);
    else if (dragController.mode && key in MOVES) {
      const [x, y, turn] = MOVES[key];
      const steps = shiftKey && turn === 0 ? FAR : 1;
      dragController.nudge(x * steps, y * steps, turn);
    } else if (dragController.mode && key === "Enter") void dragController.drop();
    else if (dragController.mode && key === "n") dragController.next();
    else if (dragController.mode && key === "Escape") {
      dragController.setMode(false);
      event.stopPropagation(); // do not stop the robots
    } else if (shiftKey && key in TURNS) scene.camera.turn(...TURNS[key]);
    else if (key in BUTTON_KEYS) {
      if (!repeat) {
        pressedKeys.add(key);
        press(BUTTON_KEYS[key], true);
      }
    } else if (key === "+" || key === "=") scene.zoom(1);
    else if (key === "-") scene.zoom(-1);
    else if (key in VIEW_KEYS) scene.setView(VIEW_KEYS[key]);
    else if (key === "b") scene.setSensors(!scene.showSensors);
    else if (key === " ") {
      if (!repeat) pause?.();
    } else if (hand !== undefined) {
      if (!repeat) useHand?.(hand);
    } else return;
    event.preventDefault();
  });
  /** @param {string} key */
  const release = (key) => {
    if (pressedKeys.delete(key)) press(BUTTON_KEYS[key], false);
  };
  element.addEventListener("keyup", ({ key }) => release(key));
  element.addEventListener("blur", () => [...pressedKeys].forEach(release));
}
