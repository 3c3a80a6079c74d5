// Draws the overlay of the creator (creator/sketch.js): grid, ghosts, outlines and handles.

import * as THREE from "three";

/** @typedef {import("../creator/sketch.js").Sketch} Sketch */
/** @typedef {import("../creator/sketch.js").Tone} Tone */

/** One row per tone: its color and opacities. */
export const TONES = /** @type {Record<Tone, { color: number, area: number, line: number }>} */ ({
  free: { color: 0x4b43b8, area: 0.45, line: 1 },
  taken: { color: 0xb3261e, area: 0.55, line: 1 },
  chosen: { color: 0x4b43b8, area: 0.22, line: 1 },
  soft: { color: 0x4a4036, area: 0, line: 0.75 },
  grid: { color: 0x3a2f22, area: 0, line: 0.13 },
});
const ABOVE_M = 0.003;
const GRID_M = 0.0012;

export class SketchModel {
  constructor() {
    this.group = new THREE.Group();
    /** @type {Sketch | null} */ this.shown = null;
    this.materials = Object.fromEntries(
      Object.entries(TONES).map(([tone, { color, area, line }]) => [
        tone,
        {
          area: new THREE.MeshBasicMaterial({
            color: color,
            transparent: true,
            opacity: area,
            depthWrite: false,
            polygonOffset: true, // avoids z-fighting with the faces it covers
            polygonOffsetFactor: -2,
            polygonOffsetUnits: -2,
          }),
          line: new THREE.LineBasicMaterial({
            color: color,
            transparent: true,
            opacity: line,
            depthTest: tone === "grid",
          }),
          knob: new THREE.MeshBasicMaterial({ color: color, transparent: true, depthTest: false }),
        },
      ]),
    );
    this.rim = new THREE.MeshBasicMaterial({ color: 0xffffff, transparent: true, depthTest: false });
  }

  /** @param {Sketch | null} sketch */
  update(sketch) {
    if (sketch === this.shown) return;
    this.shown = sketch;
    for (const mesh of this.group.children) /** @type {THREE.Mesh} */ (mesh).geometry.dispose();
    this.group.clear();
    if (sketch === null) return;
    for (const { outline, height, tone } of sketch.areas) {
      const shape = new THREE.Shape(outline.map(([x, y]) => new THREE.Vector2(x, y)));
      const geometry = new THREE.ExtrudeGeometry(shape, { depth: height + ABOVE_M, bevelEnabled: false });
      this.group.add(new THREE.Mesh(geometry, this.materials[tone].area));
    }
    for (const tone of /** @type {Tone[]} */ (Object.keys(TONES))) {
      const lines = sketch.lines.filter((line) => line.tone === tone);
      const corners = lines.flatMap(({ points }) => points.slice(1).flatMap((point, index) => [points[index], point]));
      if (corners.length === 0) continue;
      const z = tone === "grid" ? GRID_M : ABOVE_M;
      const places = corners.map(([x, y]) => new THREE.Vector3(x, y, z));
      const mesh = new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(places), this.materials[tone].line);
      mesh.renderOrder = tone === "grid" ? 0 : 1;
      this.group.add(mesh);
    }
    for (const { x, y, tone } of sketch.knobs) {
      for (const [size, material, order] of /** @type {const} */ ([
        [1.3, this.rim, 2],
        [1, this.materials[tone].knob, 3],
      ])) {
        // prettier-ignore
        const disc = new THREE.CircleGeometry(sketch.knobSize * size, 24).translate(x, y, ABOVE_M);
        const mesh = new THREE.Mesh(disc, material);
        mesh.renderOrder = order;
        this.group.add(mesh);
      }
    }
  }
}

/**
 * The same overlay in 2D; the context is in meters, y up.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Sketch} sketch
 * @param {number} pixel  meters
 */
export function drawSketch(context, { areas, lines, knobs, knobSize }, pixel) {
  for (const { outline, tone } of areas) {
    context.fillStyle = css(tone, TONES[tone].area);
    trace(context, outline);
    context.fill();
  }
  for (const { points, tone } of lines) {
    context.strokeStyle = css(tone, TONES[tone].line);
    context.lineWidth = (tone === "grid" ? 1 : 2) * pixel;
    trace(context, points);
    context.stroke();
  }
  for (const { x, y, tone } of knobs) {
    for (const [size, fill] of /** @type {const} */ ([
      [1.3, "#fff"],
      [1, css(tone, 1)],
    ])) {
      // prettier-ignore
      context.fillStyle = fill;
      context.beginPath();
      context.arc(x, y, knobSize * size, 0, 2 * Math.PI);
      context.fill();
    }
  }
}

/** @param {CanvasRenderingContext2D} context @param {readonly (readonly [number, number])[]} points */
function trace(context, points) {
  context.beginPath();
  for (const [x, y] of points) context.lineTo(x, y);
}

/** @param {Tone} tone @param {number} opacity */
function css(tone, opacity) {
  return `#${TONES[tone].color.toString(16).padStart(6, "0")}${Math.round(opacity * 255)
    .toString(16)
    .padStart(2, "0")}`;
}
