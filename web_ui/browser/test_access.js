// Read-only access for browser tests as `window.thymio`: state, drawn frames, and screen positions of parts.

import { snapshot } from "../state/index.js";

/**
 * @param {object} page
 * @param {import("../state/store.js").Store} page.store
 * @param {import("../scene/index.js").SceneView} page.scene
 * @param {import("../move/drag_controller.js").DragController} page.dragController
 * @param {import("../hosts/creator_host.js").CreatorHost} page.creator
 */
export function exposeForTests({ store, scene, dragController, creator }) {
  Object.defineProperty(window, "thymio", {
    value: Object.freeze({
      state: () => snapshot(store.state),
      frames: () => scene.frames,
      level: () => scene.quality.level,
      isPainted: () => scene.world.surroundings.wood !== null,
      screenPosition: (/** @type {number} */ x, /** @type {number} */ y, /** @type {number} */ z) =>
        scene.projection.toWindow(x, y, z),
      dragged: () => dragController.dragged,
      built: () => creator.snapshot(),
      /** @param {string} part @param {string} [robot] */
      partPosition: (part, robot) => scene.partPosition(part, robot),
      get connected() {
        return store.state.connection === "connected";
      },
    }),
  });
}
