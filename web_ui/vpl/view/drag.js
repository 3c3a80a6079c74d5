// Dragging by mouse, pen or finger. A finger drags sideways at once, in any direction after a long press, which copies;
// up and down it scrolls the rows. Escape ends a drag. While a drag lasts, work is done once per frame.

/** Movement that makes a drag of a press. */
const START_PX = 6;
const LONG_PRESS_MS = 450;
/** Near the edge of the rows they scroll. */
const EDGE_PX = 48;
const SCROLL_PX = 10;

/**
 * @typedef {object} Drags
 * @property {(source: HTMLElement) => string | null} start   the picture that follows the pointer; null: no drag
 * @property {(x: number, y: number, copy: boolean) => void} over
 * @property {(x: number, y: number, copy: boolean) => void} drop
 * @property {() => void} end                                 always called last
 */

/**
 * Watch an element whose draggable parts have `data-drag`. Returns a function that ends this.
 *
 * @param {HTMLElement} element
 * @param {HTMLElement} scroller   the rows
 * @param {Drags} drags
 */
export function watchDrags(element, scroller, drags) {
  const gestures = new Gestures(element, scroller, drags);
  /** @param {KeyboardEvent} event */
  const key = (event) => gestures.key(event);
  element.addEventListener("pointerdown", (event) => gestures.down(event));
  element.addEventListener("pointermove", (event) => gestures.move(event));
  element.addEventListener("pointerup", (event) => gestures.up(event));
  element.addEventListener("pointercancel", () => gestures.finish());
  element.addEventListener("contextmenu", (event) => gestures.isTouch && event.preventDefault());
  element.addEventListener("touchmove", (event) => gestures.isDrag && event.preventDefault(), { passive: false });
  element.addEventListener("dragstart", (event) => event.preventDefault());
  window.addEventListener("keydown", key, true);
  window.addEventListener("keyup", key, true);
  return () => {
    gestures.finish();
    window.removeEventListener("keydown", key, true);
    window.removeEventListener("keyup", key, true);
  };
}

/** Decides which presses become drags, and of which kind. */
class Gestures {
  /** @type {{ source: HTMLElement, id: number, x: number, y: number, isTouch: boolean } | null} */ #pressed = null;
  /** @type {Drag | null} */ #drag = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;
  #isLong = false;
  #x = 0;
  #y = 0;
  #ctrl = false;

  /** @param {HTMLElement} element @param {HTMLElement} scroller @param {Drags} drags */
  constructor(element, scroller, drags) {
    this.element = element;
    this.scroller = scroller;
    this.drags = drags;
  }

  get isDrag() {
    return this.#drag !== null;
  }

  /** Whether a finger is pressed: a long press opens no menu of the browser. */
  get isTouch() {
    return this.#pressed?.isTouch === true;
  }

  /** @param {PointerEvent} event */
  down(event) {
    const source = event.target instanceof Element ? event.target.closest("[data-drag]") : null;
    if (this.#pressed !== null || event.button !== 0 || !(source instanceof HTMLElement)) return;
    const isTouch = event.pointerType === "touch";
    [this.#x, this.#y] = [event.clientX, event.clientY];
    this.#pressed = { source, id: event.pointerId, x: this.#x, y: this.#y, isTouch };
    if (!isTouch) return;
    this.#timer = setTimeout(() => {
      this.#isLong = true;
      this.#begin();
    }, LONG_PRESS_MS);
  }

  /** @param {PointerEvent} event */
  move(event) {
    const pressed = this.#pressed;
    if (pressed === null || event.pointerId !== pressed.id) return;
    [this.#x, this.#y, this.#ctrl] = [event.clientX, event.clientY, event.ctrlKey || event.metaKey];
    if (this.#drag !== null) return this.#follow();
    const [dx, dy] = [Math.abs(this.#x - pressed.x), Math.abs(this.#y - pressed.y)];
    if (Math.max(dx, dy) < START_PX) return;
    clearTimeout(this.#timer);
    const isStrip = getComputedStyle(pressed.source).touchAction === "pan-x"; // it scrolls sideways
    const isFree = getComputedStyle(pressed.source).touchAction === "none";
    if (!pressed.isTouch || isFree || (isStrip ? dy > dx : dx > dy)) this.#begin();
    else this.finish(); // the finger scrolls
  }

  /** @param {PointerEvent} event */
  up(event) {
    if (this.#pressed === null || event.pointerId !== this.#pressed.id) return;
    if (this.#drag !== null) {
      this.drags.drop(event.clientX, event.clientY, event.ctrlKey || event.metaKey || this.#isLong);
      swallowClick(this.element);
    }
    this.finish();
  }

  /** @param {KeyboardEvent} event */
  key(event) {
    if (this.#drag === null) return;
    if (event.key === "Control" || event.key === "Meta") {
      this.#ctrl = event.type === "keydown";
      this.#follow();
    }
    if (event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    this.finish();
  }

  finish() {
    clearTimeout(this.#timer);
    this.#pressed = null;
    this.#isLong = false;
    const drag = this.#drag;
    this.#drag = null;
    drag?.end();
  }

  #begin() {
    if (this.#pressed === null || this.#drag !== null) return;
    const { source, id } = this.#pressed;
    const drawing = this.drags.start(source);
    if (drawing === null) return this.finish();
    this.#drag = new Drag({ source, drawing, scroller: this.scroller, drags: this.drags });
    this.element.setPointerCapture(id);
    this.#follow();
  }

  #follow() {
    this.#drag?.follow(this.#x, this.#y, this.#ctrl || this.#isLong);
  }
}

/** One drag: the picture at the pointer, what is below it, and rows that scroll near their edge. */
class Drag {
  #x = 0;
  #y = 0;
  #isCopy = false;
  /** The request for the next frame; 0: none. */
  #frame = 0;

  /** @param {{ source: HTMLElement, drawing: string, scroller: HTMLElement, drags: Drags }} options */
  constructor({ source, drawing, scroller, drags }) {
    this.source = source;
    this.scroller = scroller;
    this.drags = drags;
    this.ghost = document.createElement("div");
    this.ghost.className = "vpl-ghost";
    this.ghost.innerHTML = drawing;
    document.body.append(this.ghost);
    source.classList.add("dragged");
  }

  /** @param {number} x @param {number} y @param {boolean} isCopy */
  follow(x, y, isCopy) {
    [this.#x, this.#y, this.#isCopy] = [x, y, isCopy];
    this.#schedule();
  }

  end() {
    cancelAnimationFrame(this.#frame);
    this.source.classList.remove("dragged");
    this.ghost.remove();
    this.drags.end();
  }

  #schedule() {
    if (this.#frame === 0) this.#frame = requestAnimationFrame(() => this.#draw());
  }

  #draw() {
    this.#frame = 0;
    const [x, y] = [this.#x, this.#y];
    this.ghost.style.transform = `translate(${x}px, ${y}px)`;
    this.ghost.classList.toggle("copy", this.#isCopy);
    this.drags.over(x, y, this.#isCopy);
    const { top, bottom, left, right } = this.scroller.getBoundingClientRect();
    if (x < left || x > right) return;
    const step = y < top + EDGE_PX ? -SCROLL_PX : y > bottom - EDGE_PX ? SCROLL_PX : 0;
    const before = this.scroller.scrollTop;
    if (step !== 0) this.scroller.scrollTop += step;
    if (this.scroller.scrollTop !== before) this.#schedule();
  }
}

/** The click at the end of a drag means nothing. @param {HTMLElement} element */
function swallowClick(element) {
  /** @param {MouseEvent} event */
  const swallow = (event) => {
    event.preventDefault();
    event.stopPropagation();
  };
  element.addEventListener("click", swallow, { capture: true, once: true });
  setTimeout(() => element.removeEventListener("click", swallow, { capture: true }));
}
