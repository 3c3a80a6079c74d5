// For drawing in software: while the camera rests, desk and ground stay as they are. They are kept as an image, and a
// frame is a copy of it with walls, objects and robots drawn over it, instead of every pixel again.

import * as THREE from "three";

/** Layer of everything that is in the image; the rest is on layer 0. */
export const STILL_LAYER = 1;

export class StillGround {
  constructor() {
    this.target = new THREE.WebGLRenderTarget(1, 1, { stencilBuffer: false });
    /** @type {readonly number[]} */ this.before = [];
    this.isKept = false;
  }

  /** Draw everything anew in the next frame. */
  forget() {
    this.before = [];
  }

  /**
   * @param {THREE.WebGLRenderer} renderer
   * @param {THREE.Scene} scene
   * @param {THREE.PerspectiveCamera} camera
   */
  draw(renderer, scene, camera) {
    camera.updateMatrixWorld();
    const size = renderer.getDrawingBufferSize(new THREE.Vector2());
    const now = [...size, ...camera.matrixWorld.elements, ...camera.projectionMatrix.elements];
    const isSame = now.length === this.before.length && now.every((value, at) => value === this.before[at]);
    this.before = now;
    if (!isSame) {
      this.isKept = false;
      drawAll(renderer, scene, camera);
      return;
    }
    if (!this.isKept) this.#keep(renderer, scene, camera, size);
    renderer.autoClear = false;
    renderer.clearDepth(); // before the copy: the first clearing of a frame empties the canvas wholly
    this.#copy(renderer, size);
    camera.layers.set(0);
    renderer.render(scene, camera);
    renderer.autoClear = true;
    camera.layers.enableAll();
  }

  /** @param {THREE.WebGLRenderer} renderer @param {THREE.Scene} scene @param {THREE.Camera} camera @param {THREE.Vector2} size */
  #keep(renderer, scene, camera, size) {
    this.target.setSize(size.x, size.y);
    renderer.setRenderTarget(this.target);
    camera.layers.set(STILL_LAYER);
    renderer.render(scene, camera);
    renderer.setRenderTarget(null);
    this.isKept = true;
  }

  /** @param {THREE.WebGLRenderer} renderer @param {THREE.Vector2} size */
  #copy(renderer, { x, y }) {
    const gl = /** @type {WebGL2RenderingContext} */ (renderer.getContext());
    const kept = /** @type {any} */ (renderer.properties.get(this.target)).__webglFramebuffer;
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, kept);
    renderer.state.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.disable(gl.SCISSOR_TEST);
    gl.blitFramebuffer(0, 0, x, y, 0, 0, x, y, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    renderer.state.bindFramebuffer(gl.READ_FRAMEBUFFER, null); // else its cache would not notice that this changes with FRAMEBUFFER
  }

  dispose() {
    this.target.dispose();
  }
}

/** @param {THREE.WebGLRenderer} renderer @param {THREE.Scene} scene @param {THREE.Camera} camera */
export function drawAll(renderer, scene, camera) {
  camera.layers.enableAll();
  renderer.render(scene, camera);
}
