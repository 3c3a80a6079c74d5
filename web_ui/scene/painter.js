// Draws the world on the canvas: in 3D by the graphics card or in software, else in 2D from above.

import { watchContextLoss } from "./context_loss.js";
import { DrawingSize } from "./drawing_size.js";
import { FlatView } from "./flat.js";
import { createRenderer, isSoftware } from "./graphics.js";
import { drawAll, StillGround } from "./still_ground.js";

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./world.js").World} World */

export class Painter {
  /**
   * @param {object} options
   * @param {HTMLCanvasElement} options.canvas
   * @param {HTMLCanvasElement} options.flatCanvas  canvas over it, for the 2D view
   * @param {() => void} options.changed    it has to be drawn again
   * @param {(trouble: "lost" | "gone" | null) => void} options.contextLost   gone: permanently, drawn in 2D
   */
  constructor({ canvas, flatCanvas, changed, contextLost }) {
    this.renderer = createRenderer(canvas);
    this.isSoftware = isSoftware(this.renderer);
    this.flat = new FlatView(flatCanvas);
    this.size = new DrawingSize(canvas, this.renderer, changed);
    this.still = new StillGround();
    /** Whether the user wants 2D. */
    this.wantsFlat = false;
    this.isLost = false;
    watchContextLoss(canvas, (trouble) => {
      this.isLost = trouble === "gone";
      this.still.forget();
      contextLost(trouble);
      changed();
    });
  }

  /** Whether 3D drawing is available now. */
  get has3d() {
    return this.renderer !== null && !this.isLost;
  }

  /** Whether the view is drawn in 2D from above, because 3D is missing or by choice. */
  get isFlat() {
    return this.wantsFlat || !this.has3d;
  }

  /** The canvas that is seen. */
  get canvas() {
    return this.isFlat || this.renderer === null ? this.flat.canvas : this.renderer.domElement;
  }

  /** Give the canvas its size; call it before drawing in the same task. @param {number} ratio @param {Camera} camera */
  fit(ratio, camera) {
    const isOther = this.size.fit(ratio);
    if (isOther) camera.resize(this.size.css.width, this.size.css.height);
  }

  /**
   * @param {World} world
   * @param {Camera} camera
   * @param {object} how
   * @param {boolean} how.isWhole    nothing is kept from the frame before
   * @param {() => void} how.drawFlat  draws in 2D
   */
  draw(world, camera, { isWhole, drawFlat }) {
    const { flat, renderer, still } = this;
    flat.canvas.hidden = !this.isFlat;
    if (!this.size.isShown && !isWhole) return;
    if (this.isFlat || renderer === null) {
      world.scene.updateMatrixWorld(); // the renderer would do this; hit tests need it
      drawFlat();
      return;
    }
    // From a table robots fall, and its top then hides them: no image of the ground can.
    if (this.isSoftware && !isWhole && world.isWalled) still.draw(renderer, world.scene, camera.ready());
    else drawAll(renderer, world.scene, camera.ready());
  }
}
