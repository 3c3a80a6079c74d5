// Everything that is drawn over the playground in the creator: grid, ghost, selection, handles. Pure: lines and areas
// in meters.

import { placed } from "../playground/geometry.js";
import { kindNamed } from "../playground/kinds/index.js";
import { outlinesOf, partsOf, valuesOf } from "../playground/parts.js";
import { hasKnob, hasRing, RING_BEYOND_M } from "./pick.js";
import { middleOf, pointsOf, reachOf, yawOf } from "./place.js";

/** @typedef {import("../playground/geometry.js").Point} Point */
/** @typedef {import("../playground/parts.js").Item} Item */
/** @typedef {"free" | "taken" | "chosen" | "grid" | "soft"} Tone */
/** @typedef {{ outline: Point[], height: number, tone: Tone }} Area   a convex polygon, upright to its height */
/** @typedef {{ points: Point[], tone: Tone }} Line */
/** @typedef {{ x: number, y: number, tone: Tone }} Knob */
/** @typedef {{ areas: Area[], lines: Line[], knobs: Knob[], knobSize: number }} Sketch */

const MOST_LINES = 240;
const KNOB_PX = 8;
const RING_SIDES = 64;
const ARROW = { from: 0.09, to: 0.17, head: 0.025 };

/** @param {import("./creator_model.js").CreatorModel} model @returns {Sketch} */
export function sketchOf(model) {
  const { playground, ghost, item, placing } = model;
  /** @type {Sketch} */ const sketch = {
    areas: [],
    lines: gridOf(model),
    knobs: [],
    knobSize: KNOB_PX * model.pixel,
  };
  for (const one of playground.items) {
    if (one.kind === "robot" && one.name !== ghost?.item.name) sketch.lines.push(...arrowOf(one, "soft"));
  }
  if (ghost !== null) {
    const tone = ghost.problem === null ? "free" : "taken";
    draw(sketch, ghost.item, tone);
  }
  if (placing !== null) {
    const tone = ghost?.problem ? "taken" : "free";
    for (const [x, y] of placing.points) sketch.knobs.push({ x, y, tone });
    if (placing.isPath) sketch.knobs.push({ x: placing.place[0], y: placing.place[1], tone });
  } else if (item !== null)
    handlesOf(sketch, ghost?.item ?? item, ghost === null ? "chosen" : ghost.problem === null ? "free" : "taken");
  return sketch;
}

/** @param {Sketch} sketch @param {Item} item @param {Tone} tone */
function draw(sketch, item, tone) {
  for (const { outline, height } of outlinesOf(item)) {
    sketch.areas.push({ outline, height, tone });
    sketch.lines.push({ points: [...outline, outline[0]], tone });
  }
  if (item.kind === "robot") sketch.lines.push(...arrowOf(item, tone));
  sketch.lines.push(...hintsOf(item, tone));
}

/** @param {Sketch} sketch @param {Item} item @param {Tone} tone */
function handlesOf(sketch, item, tone) {
  const isGround = kindNamed(item.kind)?.group === "ground";
  for (const { outline, height } of outlinesOf(item)) {
    if (isGround && height > 0) continue; // its walls
    if (height > 0) sketch.areas.push({ outline, height, tone });
    sketch.lines.push({ points: [...outline, outline[0]], tone });
  }
  sketch.lines.push(...hintsOf(item, tone));
  const [x, y] = middleOf(item);
  for (const [px, py] of pointsOf(item)) sketch.knobs.push({ x: px, y: py, tone });
  if (hasKnob(item)) sketch.knobs.push({ x, y, tone });
  if (!hasRing(item)) return;
  const radius = reachOf(item) + RING_BEYOND_M;
  const ring = Array.from({ length: RING_SIDES + 1 }, (_, side) => {
    const angle = (2 * Math.PI * side) / RING_SIDES;
    return /** @type {Point} */ ([x + radius * Math.cos(angle), y + radius * Math.sin(angle)]);
  });
  sketch.lines.push({ points: ring, tone });
  const yaw = yawOf(item);
  sketch.knobs.push({ x: x + radius * Math.cos(yaw), y: y + radius * Math.sin(yaw), tone });
}

/** The heading arrow of a robot. @param {Item} item @param {Tone} tone @returns {Line[]} */
function arrowOf(item, tone) {
  const [x, y] = middleOf(item);
  const { from, to, head } = ARROW;
  /** @type {Point[][]} */ const strokes = [
    [
      [from, 0],
      [to, 0],
    ],
    [
      [to - head, head],
      [to, 0],
      [to - head, -head],
    ],
  ];
  return strokes.map((points) => ({ points: placed({ x, y, yaw: yawOf(item) }, points), tone }));
}

/**
 * Invisible parts: the open position of a door and the trigger area of a plate.
 *
 * @param {Item} item
 * @param {Tone} tone
 * @returns {Line[]}
 */
function hintsOf(item, tone) {
  if (item.kind === "door") {
    const { closed_x_m, closed_y_m, opened_x_m, opened_y_m } = valuesOf(item);
    const [dx, dy] = [opened_x_m - closed_x_m, opened_y_m - closed_y_m];
    const opened = outlinesOf(item)[0].outline.map(([x, y]) => /** @type {Point} */ ([x + dx, y + dy]));
    return [
      { points: [...opened, opened[0]], tone },
      { points: [[closed_x_m, closed_y_m], [opened_x_m, opened_y_m]], tone }, // prettier-ignore
    ];
  }
  return partsOf(item).primitives.flatMap((part) =>
    part.type === "trigger" ? [{ points: [...part.vertices, part.vertices[0]], tone }] : [],
  );
}

/**
 * The grid over all grounds; coarser where lines would be too dense.
 *
 * @param {import("./creator_model.js").CreatorModel} model
 * @returns {Line[]}
 */
function gridOf({ playground, grid, pixel }) {
  const corners = playground.items.flatMap((item) => partsOf(item).floors.flat());
  if (corners.length === 0) corners.push([-0.5, -0.5], [0.5, 0.5]);
  const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
  const [left, right, bottom, top] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  let step = grid.size;
  while (step < 5 * pixel || (right - left + top - bottom) / step > MOST_LINES) step *= 2;
  /** @type {Line[]} */ const lines = [];
  for (let x = Math.ceil(left / step - 1e-6) * step; x <= right + 1e-6; x += step)
    lines.push({
      points: [
        [x, bottom],
        [x, top],
      ],
      tone: "grid",
    });
  for (let y = Math.ceil(bottom / step - 1e-6) * step; y <= top + 1e-6; y += step)
    lines.push({
      points: [
        [left, y],
        [right, y],
      ],
      tone: "grid",
    });
  return lines;
}
