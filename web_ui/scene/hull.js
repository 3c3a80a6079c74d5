// The shell of the robot as rings around its outline: round front, flat back, wheel arches, a round edge on top.
// Corners carry the shade of the place (ambient occlusion) and how much of the top light shines through there.

import * as THREE from "three";

import { HEIGHT_M, WHEEL } from "./parts.js";

/** @typedef {{ x: number, y: number, nx: number, ny: number, foot: number }} Column  a place of the outline, its normal, and where the shell begins */
/** @typedef {{ z: number, inset: number, up: number }} Ring  up: tilt of the normal, rad */

const HALF_WIDTH_M = 0.056;
const REAR_M = -0.03;
const CORNER_M = 0.0062;
const FRONT_M = 0.08;
/** Radius where side and front meet. */
const CHEEK_M = 0.008;
const ARCH = { radius: 0.0234, inner: 0.0385 };
const FOOT_M = 0.004;
const BEVEL = { from: 0.0475, inset: 0.0062 };
/** On top, light shines through from this share of the way to the rim on. */
const DARK_SHARE = 0.55;
const MIDDLE_X_M = 0.022;
const GLOW = { foot: 0.006, top: 0.051, side: 0.22, rim: 0.44 };
const SHADE = { foot: 0.7, until: 0.034, arch: 0.45 };
const WHITE = [1, 0.992, 0.975];

/** How finely the shell is divided. */
export const HULLS = {
  near: { front: 18, corner: 3, arch: 8, rings: [FOOT_M, 0.0175, SHADE.until, BEVEL.from], bevel: 3 },
  outline: { front: 14, corner: 2, arch: 0, rings: [FOOT_M, BEVEL.from], bevel: 2 },
  far: { front: 5, corner: 1, arch: 4, rings: [FOOT_M, BEVEL.from], bevel: 1 },
};

/** The outline, counter-clockwise seen from above, starting at the back. @param {typeof HULLS.near} fineness @returns {Column[]} */
export function outlineColumns({ front, corner, arch }) {
  /** @type {Column[]} */ const half = []; // the right side, from the back to the front
  const [cornerX, cornerY] = [REAR_M + CORNER_M, -HALF_WIDTH_M + CORNER_M];
  for (let step = 0; step <= corner; step++) {
    const angle = Math.PI + ((Math.PI / 2) * step) / corner;
    const [nx, ny] = [Math.cos(angle), Math.sin(angle)];
    half.push({ x: cornerX + CORNER_M * nx, y: cornerY + CORNER_M * ny, nx, ny, foot: FOOT_M });
  }
  const side = { y: -HALF_WIDTH_M, nx: 0, ny: -1 };
  if (arch > 0) {
    half.push({ ...side, x: -ARCH.radius, foot: FOOT_M });
    for (let step = 0; step <= arch; step++) {
      const angle = Math.PI - (Math.PI * step) / arch;
      half.push({ ...side, x: ARCH.radius * Math.cos(angle), foot: WHEEL.radius + ARCH.radius * Math.sin(angle) });
    }
    half.push({ ...side, x: ARCH.radius, foot: FOOT_M });
  }
  const cheek = { y: -HALF_WIDTH_M + CHEEK_M, x: Math.sqrt((FRONT_M - CHEEK_M) ** 2 - (HALF_WIDTH_M - CHEEK_M) ** 2) };
  const end = Math.atan2(-cheek.y, cheek.x); // there the front arc begins
  for (let step = 0; step < corner; step++) {
    const angle = -Math.PI / 2 + ((Math.PI / 2 - end) * step) / corner;
    const [nx, ny] = [Math.cos(angle), Math.sin(angle)];
    half.push({ x: cheek.x + CHEEK_M * nx, y: cheek.y + CHEEK_M * ny, nx, ny, foot: FOOT_M });
  }
  const arc = Array.from({ length: front + 1 }, (_, step) => {
    const angle = end * ((2 * step) / front - 1);
    const [nx, ny] = [Math.cos(angle), Math.sin(angle)];
    return { x: FRONT_M * nx, y: FRONT_M * ny, nx, ny, foot: FOOT_M };
  });
  const mirrored = half.map((one) => ({ ...one, y: -one.y, ny: -one.ny })).reverse();
  return [...half, ...arc, ...mirrored];
}

/** @param {typeof HULLS.near} fineness @returns {Ring[]} */
function ringsOf({ rings, bevel }) {
  const low = rings.map((z) => ({ z, inset: 0, up: 0 }));
  const round = Array.from({ length: bevel }, (_, step) => {
    const angle = (Math.PI / 2) * ((step + 1) / bevel);
    return {
      z: BEVEL.from + (HEIGHT_M - BEVEL.from) * Math.sin(angle),
      inset: BEVEL.inset * (1 - Math.cos(angle)),
      up: angle,
    };
  });
  return [...low, ...round];
}

/** Collects triangles of one mesh. */
export class Builder {
  constructor() {
    /** @type {number[]} */ this.positions = [];
    /** @type {number[]} */ this.normals = [];
    /** @type {number[]} */ this.colors = [];
    /** @type {number[]} */ this.glows = [];
    /** @type {number[]} */ this.lamps = [];
    /** @type {number[]} */ this.indices = [];
  }

  /**
   * @param {readonly number[]} position
   * @param {readonly number[]} normal
   * @param {readonly number[]} color
   * @param {{ glow?: number, lamp?: number }} [light]
   */
  corner(position, normal, color, { glow = 0, lamp = 0 } = {}) {
    this.positions.push(...position);
    this.normals.push(...normal);
    this.colors.push(...color);
    this.glows.push(glow);
    this.lamps.push(lamp);
    return this.glows.length - 1;
  }

  /** A triangle; nothing if two of its corners are at the same place. @param {number} a @param {number} b @param {number} c */
  triangle(a, b, c) {
    /** @param {number} one @param {number} other */
    const same = (one, other) =>
      [0, 1, 2].every((axis) => Math.abs(this.positions[3 * one + axis] - this.positions[3 * other + axis]) < 1e-7);
    if (!same(a, b) && !same(b, c) && !same(a, c)) this.indices.push(a, b, c);
  }

  /** @param {number} a @param {number} b @param {number} c @param {number} d  counter-clockwise */
  quad(a, b, c, d) {
    this.triangle(a, b, c);
    this.triangle(a, c, d);
  }

  /** Another geometry in one color. @param {THREE.BufferGeometry} shape  is disposed @param {readonly number[]} color @param {number} [lamp] */
  add(shape, color, lamp = 0) {
    const { position, normal } = shape.attributes;
    const first = this.glows.length;
    for (let at = 0; at < position.count; at++) {
      const place = new THREE.Vector3().fromBufferAttribute(position, at);
      const facing = new THREE.Vector3().fromBufferAttribute(normal, at);
      this.corner(place.toArray(), facing.toArray(), color, { lamp });
    }
    const indices = shape.index === null ? [...Array(position.count).keys()] : [...shape.index.array];
    for (const index of indices) this.indices.push(first + index);
    shape.dispose();
  }

  geometry() {
    const geometry = new THREE.BufferGeometry();
    for (const [name, values, size] of /** @type {const} */ ([
      ["position", this.positions, 3],
      ["normal", this.normals, 3],
      ["color", this.colors, 3],
      ["aGlow", this.glows, 1],
      ["aLamp", this.lamps, 1],
    ])) {
      geometry.setAttribute(name, new THREE.Float32BufferAttribute(values, size));
    }
    return geometry.setIndex(this.indices);
  }
}

/**
 * Add the shell.
 *
 * @param {Builder} builder
 * @param {typeof HULLS.near} fineness
 */
export function addHull(builder, fineness) {
  const columns = outlineColumns(fineness);
  const rings = ringsOf(fineness);
  const corners = rings.map((ring) => columns.map((column) => shellCorner(builder, column, ring)));
  for (let level = 1; level < rings.length; level++) {
    columns.forEach((_, at) => {
      const next = (at + 1) % columns.length;
      builder.quad(corners[level - 1][at], corners[level - 1][next], corners[level][next], corners[level][at]);
    });
  }
  addTop(builder, columns);
  if (fineness.arch > 0) addArches(builder, columns);
  addFloor(builder, columns);
}

/** @param {Builder} builder @param {Column} column @param {Ring} ring */
function shellCorner(builder, { x, y, nx, ny, foot }, { z, inset, up }) {
  const height = Math.max(z, foot);
  const shade = SHADE.foot + (1 - SHADE.foot) * Math.min(1, height / SHADE.until);
  const rim = Math.min(1, inset / BEVEL.inset);
  const side = GLOW.side * Math.min(1, Math.max(0, (height - GLOW.foot) / (GLOW.top - GLOW.foot)));
  return builder.corner(
    [x - inset * nx, y - inset * ny, height],
    [nx * Math.cos(up), ny * Math.cos(up), Math.sin(up)],
    WHITE.map((value) => value * shade),
    { glow: side + (GLOW.rim - side) * rim },
  );
}

/** The top face: light shines through near its rim. @param {Builder} builder @param {Column[]} columns */
function addTop(builder, columns) {
  const up = [0, 0, 1];
  /** @param {number} share @param {number} glow */
  const ring = (share, glow) =>
    columns.map(({ x, y, nx, ny }) => {
      const [rimX, rimY] = [x - BEVEL.inset * nx, y - BEVEL.inset * ny];
      return builder.corner([MIDDLE_X_M + (rimX - MIDDLE_X_M) * share, rimY * share, HEIGHT_M], up, WHITE, { glow });
    });
  const [rim, inner] = [ring(1, GLOW.rim), ring(DARK_SHARE, 0)];
  const middle = builder.corner([MIDDLE_X_M, 0, HEIGHT_M], up, WHITE);
  columns.forEach((_, at) => {
    const next = (at + 1) % columns.length;
    builder.quad(rim[at], rim[next], inner[next], inner[at]);
    builder.triangle(inner[at], inner[next], middle);
  });
}

/** The inside of the wheel arches. @param {Builder} builder @param {Column[]} columns */
function addArches(builder, columns) {
  const shade = WHITE.map((value) => value * SHADE.arch);
  columns.forEach((from, at) => {
    const to = columns[(at + 1) % columns.length];
    const side = Math.sign(from.y);
    const isArch = [from, to].every(({ x, ny }) => Math.abs(x) < ARCH.radius + 1e-6 && Math.abs(ny) === 1);
    if (!isArch) return;
    /** @param {Column} column @param {number} y @param {number} z */
    const inside = ({ x }, y, z) =>
      builder.corner([x, side * y, z], [-x / ARCH.radius, 0, (WHEEL.radius - z) / ARCH.radius], shade);
    const roof = [
      inside(from, HALF_WIDTH_M, from.foot),
      inside(from, ARCH.inner, from.foot),
      inside(to, ARCH.inner, to.foot),
      inside(to, HALF_WIDTH_M, to.foot),
    ];
    builder.quad(roof[0], roof[1], roof[2], roof[3]);
    /** @param {Column} column @param {number} z */
    const wall = ({ x }, z) => builder.corner([x, side * ARCH.inner, z], [0, side, 0], shade);
    builder.quad(wall(from, FOOT_M), wall(to, FOOT_M), wall(to, to.foot), wall(from, from.foot));
  });
}

/** The underside, seen when the robot leans. @param {Builder} builder @param {Column[]} columns */
function addFloor(builder, columns) {
  const dark = WHITE.map((value) => value * SHADE.arch);
  const low = columns.filter(({ foot }, at) => foot === FOOT_M && at % 3 === 0);
  const corners = low.map(({ x, y }) => builder.corner([x, y, FOOT_M], [0, 0, -1], dark));
  for (let at = 2; at < corners.length; at++) builder.triangle(corners[0], corners[at], corners[at - 1]);
}
