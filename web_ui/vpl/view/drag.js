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
  /** @type {{ source: HTMLElement, id: number, x: number, y: number, isTouch: boolean } | null} */ let pressed = null;
  /** @type {HTMLElement | null} */ let ghost = null;
  let isLong = false;
  let [x, y, ctrl, frame] = [0, 0, false, 0];
  /** @type {ReturnType<typeof setTimeout> | undefined} */ let timer;
  const isCopy = () => ctrl || isLong;

  const draw = () => {
    frame = 0;
    if (ghost === null) return;
    ghost.style.transform = `translate(${x}px, ${y}px)`;
    ghost.classList.toggle("copy", isCopy());
    drags.over(x, y, isCopy());
    const { top, bottom, left, right } = scroller.getBoundingClientRect();
    if (x < left || x > right) return;
    const step = y < top + EDGE_PX ? -SCROLL_PX : y > bottom - EDGE_PX ? SCROLL_PX : 0;
    const before = scroller.scrollTop;
    if (step !== 0) scroller.scrollTop += step;
    if (scroller.scrollTop !== before) schedule();
  };
  const schedule = () => {
    if (frame === 0) frame = requestAnimationFrame(draw);
  };

  const begin = () => {
    if (pressed === null || ghost !== null) return;
    const drawing = drags.start(pressed.source);
    if (drawing === null) return finish();
    ghost = document.createElement("div");
    ghost.className = "vpl-ghost";
    ghost.innerHTML = drawing;
    document.body.append(ghost);
    pressed.source.classList.add("dragged");
    element.setPointerCapture(pressed.id);
    schedule();
  };

  const finish = () => {
    clearTimeout(timer);
    cancelAnimationFrame(frame);
    frame = 0;
    pressed?.source.classList.remove("dragged");
    pressed = null;
    isLong = false;
    if (ghost === null) return;
    ghost.remove();
    ghost = null;
    drags.end();
  };

  /** @param {PointerEvent} event */
  const down = (event) => {
    const source = event.target instanceof Element ? event.target.closest("[data-drag]") : null;
    if (pressed !== null || event.button !== 0 || !(source instanceof HTMLElement)) return;
    const isTouch = event.pointerType === "touch";
    [x, y] = [event.clientX, event.clientY];
    pressed = { source, id: event.pointerId, x, y, isTouch };
    if (!isTouch) return;
    timer = setTimeout(() => {
      isLong = true;
      begin();
    }, LONG_PRESS_MS);
  };
  /** @param {PointerEvent} event */
  const move = (event) => {
    if (pressed === null || event.pointerId !== pressed.id) return;
    [x, y, ctrl] = [event.clientX, event.clientY, event.ctrlKey || event.metaKey];
    if (ghost !== null) return schedule();
    const [dx, dy] = [Math.abs(x - pressed.x), Math.abs(y - pressed.y)];
    if (Math.max(dx, dy) < START_PX) return;
    clearTimeout(timer);
    const isStrip = getComputedStyle(pressed.source).touchAction === "pan-x"; // it scrolls sideways
    const isFree = getComputedStyle(pressed.source).touchAction === "none";
    if (!pressed.isTouch || isFree || (isStrip ? dy > dx : dx > dy)) begin();
    else finish(); // the finger scrolls
  };
  /** @param {PointerEvent} event */
  const up = (event) => {
    if (pressed === null || event.pointerId !== pressed.id) return;
    if (ghost !== null) {
      drags.drop(event.clientX, event.clientY, event.ctrlKey || event.metaKey || isLong);
      swallowClick();
    }
    finish();
  };
  /** The click at the end of a drag means nothing. */
  const swallowClick = () => {
    /** @param {MouseEvent} event */
    const swallow = (event) => {
      event.preventDefault();
      event.stopPropagation();
    };
    element.addEventListener("click", swallow, { capture: true, once: true });
    setTimeout(() => element.removeEventListener("click", swallow, { capture: true }));
  };
  /** @param {KeyboardEvent} event */
  const key = (event) => {
    if (ghost === null) return;
    if (event.key === "Control" || event.key === "Meta") {
      ctrl = event.type === "keydown";
      schedule();
    }
    if (event.key !== "Escape") return;
    event.preventDefault();
    event.stopPropagation();
    finish();
  };
  /** @param {Event} event */
  const prevent = (event) => {
    if (ghost !== null) event.preventDefault();
  };
  /** @param {Event} event  a long press opens no menu of the browser */
  const menu = (event) => {
    if (pressed?.isTouch) event.preventDefault();
  };

  element.addEventListener("pointerdown", down);
  element.addEventListener("pointermove", move);
  element.addEventListener("pointerup", up);
  element.addEventListener("pointercancel", finish);
  element.addEventListener("contextmenu", menu);
  element.addEventListener("touchmove", prevent, { passive: false });
  element.addEventListener("dragstart", (event) => event.preventDefault());
  window.addEventListener("keydown", key, true);
  window.addEventListener("keyup", key, true);
  return () => {
    finish();
    window.removeEventListener("keydown", key, true);
    window.removeEventListener("keyup", key, true);
  };
}
