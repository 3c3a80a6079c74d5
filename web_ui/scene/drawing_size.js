// The size of the view and of the canvas it is drawn on. A canvas that gets another size is empty. So only a frame may
// give it one, right before it draws (`fit`), and everything else asks for a frame: no empty canvas is ever shown.

/** @typedef {{ width: number, height: number }} Size */

export class DrawingSize {
  /**
   * @param {HTMLCanvasElement} canvas
   * @param {import("three").WebGLRenderer | null} renderer
   * @param {() => void} changed   the view has another size, or is shown again
   */
  constructor(canvas, renderer, changed) {
    this.renderer = renderer;
    /** @type {Size} CSS pixels; kept, since reading it after moving a label forces a layout */
    this.css = { width: 0, height: 0 };
    /** Whether the view has room: on phones it has none beside some tabs. */
    this.isShown = false;
    /** @type {Size & { ratio: number }} what the canvas has */ this.fitted = { width: 0, height: 0, ratio: 0 };
    new ResizeObserver(() => {
      this.#measure(canvas);
      changed();
    }).observe(canvas);
    this.#measure(canvas);
  }

  /**
   * Give the canvas the size of the view. Call it before drawing in the same task.
   *
   * @param {number} ratio   pixels per CSS pixel
   * @returns {boolean}   whether the view has another size than before, in CSS pixels
   */
  fit(ratio) {
    const { css, fitted } = this;
    const isOther = css.width !== fitted.width || css.height !== fitted.height;
    if (!isOther && ratio === fitted.ratio) return false;
    if (css.width === 0) return false; // never shown
    this.fitted = { ...css, ratio };
    this.renderer?.setDrawingBufferSize(css.width, css.height, ratio);
    return isOther;
  }

  /** @param {HTMLCanvasElement} canvas */
  #measure({ clientWidth: width, clientHeight: height }) {
    this.isShown = width > 0 && height > 0;
    if (this.isShown) this.css = { width, height }; // hidden, it keeps its size
  }
}
