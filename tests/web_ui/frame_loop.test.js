import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";

import { DrawingSize } from "../../web_ui/scene/drawing_size.js";
import { FrameLoop } from "../../web_ui/scene/loop.js";
import { LEVELS, Quality } from "../../web_ui/scene/quality.js";

/** @type {((nowMs: number) => void)[]} */ let frames = [];
/** @type {(() => void)[]} */ let timers = [];
/** @type {() => void} */ let resized = () => {};

beforeEach(() => {
  [frames, timers] = [[], []];
  const browser = /** @type {any} */ (globalThis);
  browser.requestAnimationFrame = (/** @type {(nowMs: number) => void} */ callback) => frames.push(callback);
  browser.window = {
    setTimeout: (/** @type {() => void} */ callback) => timers.push(callback),
    clearTimeout: (/** @type {number} */ number) => (timers[number - 1] = () => {}),
  };
  browser.ResizeObserver = class {
    constructor(/** @type {() => void} */ callback) {
      resized = callback;
    }
    observe() {}
  };
});

/** A view as the page has it: a canvas that is empty whenever it gets a size. */
function view() {
  const canvas = { clientWidth: 400, clientHeight: 300, isEmpty: true, sizes: /** @type {number[][]} */ ([]) };
  const renderer = {
    setDrawingBufferSize(/** @type {number[]} */ ...size) {
      canvas.sizes.push(size);
      canvas.isEmpty = true;
    },
  };
  const quality = new Quality({ isSoftware: true });
  const world = { moving: false };
  const draw = () => {
    size.fit(quality.settings.pixelRatio);
    if (size.isShown) canvas.isEmpty = false;
    return world.moving;
  };
  const loop = new FrameLoop({ quality, draw });
  const size = new DrawingSize(/** @type {any} */ (canvas), /** @type {any} */ (renderer), () => loop.invalidate());
  let nowMs = 0;
  /** The next frame, this much later. */
  const frame = (intervalMs = 100) => {
    nowMs += intervalMs;
    for (const callback of frames.splice(0)) callback(nowMs);
    assert.equal(canvas.isEmpty, false, "what the browser shows now");
  };
  return { canvas, quality, world, loop, frame };
}

/** Slow frames until this level. @param {ReturnType<typeof view>} page @param {number} level */
function slowUntil({ quality, world, loop, frame }, level) {
  world.moving = true;
  loop.invalidate();
  while (quality.level < level) frame();
}

for (const level of [...LEVELS.keys()].slice(1)) {
  test(`no empty canvas is shown at level ${level}: when it comes, at rest, on the next movement`, () => {
    const page = view();
    page.loop.invalidate();
    page.frame();
    slowUntil(page, level);
    page.world.moving = false;
    page.frame();
    for (const end of timers.splice(0)) end();
    for (let message = 0; message < 4; message++) {
      page.loop.invalidate();
      page.frame();
    }
    assert.deepEqual(page.canvas.sizes.at(-1), [400, 300, 1], "all pixels at rest");
    page.world.moving = true;
    page.loop.invalidate();
    page.frame();
    page.frame();
    assert.deepEqual(page.canvas.sizes.at(-1), [400, 300, LEVELS[level].pixelRatio]);
  });
}

test("another size of the view does not empty the canvas, but asks for a frame, which gives it the size", () => {
  const { canvas, loop, frame } = view();
  loop.invalidate();
  frame();
  Object.assign(canvas, { clientWidth: 250 });
  resized();
  assert.equal(canvas.isEmpty, false);
  frame();
  assert.deepEqual(canvas.sizes.at(-1), [250, 300, 1]);
  assert.equal(frames.length, 0, "and no more");
});

test("a hidden view keeps its size, and is drawn when it is shown again", () => {
  const { canvas, loop, frame } = view();
  loop.invalidate();
  frame();
  Object.assign(canvas, { clientWidth: 0, clientHeight: 0 });
  resized();
  frame();
  Object.assign(canvas, { clientWidth: 400, clientHeight: 300 });
  resized();
  assert.equal(frames.length, 1);
  frame();
  assert.deepEqual(canvas.sizes, [[400, 300, 1]]);
});

test("a change of the level that keeps the resolution keeps the canvas", () => {
  const page = view();
  slowUntil(page, 3);
  assert.deepEqual(page.canvas.sizes, [[400, 300, 1]]);
});

test("messages that move nothing do not put off the full resolution", () => {
  const page = view();
  slowUntil(page, 5);
  page.world.moving = false;
  page.frame();
  assert.equal(timers.length, 1);
  for (let message = 0; message < 4; message++) {
    page.loop.invalidate();
    page.frame();
  }
  assert.equal(timers.length, 1, "one timer, not one for each message");
  timers[0]();
  page.frame();
  assert.equal(page.canvas.sizes.at(-1)?.[2], 1);
});
