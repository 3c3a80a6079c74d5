// Keys on the 3D view: arrows and Enter are the robot's buttons, with Shift they turn the camera.

/** @typedef {import("./scene/index.js").SceneView} SceneView */

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
const VIEW_KEYS = /** @type {Record<string, import("./scene/camera.js").ViewName>} */ ({
  Home: "home",
  t: "top",
  f: "follow",
});

/**
 * @param {HTMLElement} element  which must have the focus
 * @param {SceneView} scene
 * @param {(button: string, pressed: boolean) => void} press
 */
export function watchKeyboard(element, scene, press) {
  /** @type {Set<string>} */ const held = new Set();
  element.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const { key, shiftKey, repeat } = event;
    if (shiftKey && key in TURNS) scene.camera.turn(...TURNS[key]);
    else if (key in BUTTON_KEYS) {
      if (!repeat) {
        held.add(key);
        press(BUTTON_KEYS[key], true);
      }
    } else if (key === "+" || key === "=") scene.camera.zoom(1);
    else if (key === "-") scene.camera.zoom(-1);
    else if (key in VIEW_KEYS) scene.look(VIEW_KEYS[key]);
    else return;
    event.preventDefault();
  });
  /** @param {string} key */
  const release = (key) => {
    if (held.delete(key)) press(BUTTON_KEYS[key], false);
  };
  element.addEventListener("keyup", ({ key }) => release(key));
  element.addEventListener("blur", () => [...held].forEach(release));
}
