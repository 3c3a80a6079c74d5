// Everything on the shell of the robot: windows of the sensors, buttons, lights, pen hole, studs, seam, connectors.

import * as THREE from "three";

import { outlineColumns } from "./hull.js";
import { LAMP_COLUMNS } from "./lamps.js";
import { BUTTON_PLACES, HEIGHT_M, LIGHTS, PROXIMITY_PLACES, RGB_LIGHTS, WHEEL } from "./parts.js";

/** @typedef {import("./hull.js").Builder} Builder */

const DARK = [0.17, 0.155, 0.145];
const HOLE = [0.13, 0.12, 0.115];
const BEZEL = [0.9, 0.885, 0.86];
const SEAM = [0.62, 0.595, 0.565];
const RIM = [0.83, 0.815, 0.79];
const STUD = [0.985, 0.975, 0.955];
const UNLIT_RING = [0.79, 0.765, 0.725];
const UNLIT = [0.8, 0.775, 0.745];
const BUTTON = [0.6, 0.58, 0.555];
const STRIP = [0.86, 0.845, 0.82];
const WHITE = [1, 0.992, 0.975];

const TOP_M = HEIGHT_M + 0.0003;
const BUTTON_M = 0.0011;
const WINDOW = { across: 0.011, high: 0.0095, before: 0.00045 };
const RING = { x: 0.0489, inner: 0.0218, outer: 0.025, gap: 0.13 };
const SEAM_AT = { low: 0.0166, high: 0.0175, before: 0.00018 };
const PEN_HOLE_M = 0.0062;
const STUDS = { x: [-0.016, -0.008, 0, 0.008], y: [-0.04, -0.032, 0.032, 0.04], radius: 0.0024, high: 0.0015 };
/** Size of a light on a distant robot, in radii. */
const FAR = 2.5;
/** Lights that are drawn on distant robots; the others are on the sides or under the front. */
const SEEN_FROM_FAR = new Set(["circle", "buttons", "proximity"]);
const HEADINGS = /** @type {Record<string, number>} */ ({ forward: 0, left: 90, backward: 180, right: -90 });
const UP = new THREE.Vector3(0, 0, 1);

/** @param {Builder} builder */
export function addDetails(builder) {
  addWindows(builder);
  addSeam(builder);
  addStuds(builder);
  addButtons(builder);
  addRing(builder);
  for (const light of LIGHTS) if (light.group !== "circle") addLight(builder, light, light.radius, 6, UNLIT);
  addStrips(builder, STRIP);
  const top = (/** @type {THREE.BufferGeometry} */ shape) => shape.translate(0, 0, TOP_M);
  builder.add(top(new THREE.CircleGeometry(PEN_HOLE_M, 14)), HOLE);
  builder.add(top(new THREE.RingGeometry(PEN_HOLE_M, PEN_HOLE_M + 0.0015, 14)), RIM);
  const rear = (/** @type {THREE.BufferGeometry} */ shape, /** @type {number} */ before) =>
    shape.rotateY(-Math.PI / 2).translate(-0.03 - before, 0, 0.0285);
  builder.add(rear(new THREE.PlaneGeometry(0.006, 0.0125), 0.0002), BEZEL); // USB
  builder.add(rear(new THREE.PlaneGeometry(0.0034, 0.0098), 0.0005), HOLE);
  builder.add(new THREE.BoxGeometry(0.006, 0.012, 0.004).translate(-0.031, 0, 0.0085), RIM); // trailer hook
}

/** The lights that are seen from far away, without their unlit look. @param {Builder} builder */
export function addFarDetails(builder) {
  for (const light of LIGHTS) {
    if (SEEN_FROM_FAR.has(light.group)) addLight(builder, light, light.radius * FAR, 3, WHITE);
  }
  addStrips(builder, STRIP);
  for (const side of [1, -1]) {
    const wheel = new THREE.CircleGeometry(WHEEL.radius, 8).rotateX((-side * Math.PI) / 2);
    builder.add(wheel.translate(0, side * 0.0562, WHEEL.radius), DARK);
  }
  builder.add(new THREE.CircleGeometry(PEN_HOLE_M, 5).translate(0, 0, TOP_M), HOLE);
  for (const { x, y, z, yaw } of windows()) {
    builder.add(pane(WINDOW.across, WINDOW.high, 0).rotateZ(yaw).translate(x, y, z), DARK);
  }
}

/** The windows of the distance sensors, on the surface of the shell. */
function windows() {
  return Object.values(PROXIMITY_PLACES).map(({ x, y, z, yaw }) => {
    const toSurface = x < 0 ? -0.0305 / x : 0.0803 / Math.hypot(x, y);
    return { x: x < 0 ? -0.0305 : x * toSurface, y: x < 0 ? y : y * toSurface, z, yaw };
  });
}

/** An upright pane that faces x, with its corners cut. @param {number} across @param {number} high @param {number} cut */
function pane(across, high, cut) {
  const [w, h] = [across / 2, high / 2];
  /** @type {[number, number][]} */
  const places = [
    [-w + cut, -h],
    [w - cut, -h],
    [w, -h + cut],
    [w, h - cut],
    [w - cut, h],
    [-w + cut, h],
    [-w, h - cut],
    [-w, -h + cut],
  ];
  const corners = cut > 0 ? places : [places[7], places[2], places[3], places[6]];
  const shape = new THREE.ShapeGeometry(new THREE.Shape(corners.map(([x, y]) => new THREE.Vector2(x, y))));
  return shape.rotateX(Math.PI / 2).rotateZ(Math.PI / 2);
}

/** @param {Builder} builder */
function addWindows(builder) {
  for (const { x, y, z, yaw } of windows()) {
    /** @param {THREE.BufferGeometry} shape @param {number} before */
    const put = (shape, before) =>
      shape.rotateZ(yaw).translate(x + before * Math.cos(yaw), y + before * Math.sin(yaw), z);
    builder.add(put(pane(WINDOW.across + 0.0022, WINDOW.high + 0.0022, 0), WINDOW.before / 2), BEZEL);
    builder.add(put(pane(WINDOW.across, WINDOW.high, 0.002), WINDOW.before), DARK);
  }
}

/** The line where upper and lower shell meet. @param {Builder} builder */
function addSeam(builder) {
  const columns = outlineColumns({ front: 14, corner: 2, arch: 2, rings: [], bevel: 0 });
  columns.forEach((from, at) => {
    const to = columns[(at + 1) % columns.length];
    const inArch = [from, to].every(({ x, ny }) => Math.abs(x) < 0.0235 && Math.abs(ny) === 1);
    if (inArch) return;
    /** @param {import("./hull.js").Column} column @param {number} z */
    const corner = ({ x, y, nx, ny }, z) =>
      builder.corner([x + SEAM_AT.before * nx, y + SEAM_AT.before * ny, z], [nx, ny, 0], SEAM);
    builder.quad(corner(from, SEAM_AT.low), corner(to, SEAM_AT.low), corner(to, SEAM_AT.high), corner(from, SEAM_AT.high));
  });
}

/** A flat part with sides, standing on the top. @param {Builder} builder @param {[number, number][]} outline @param {number} high @param {readonly number[]} color @param {number} [lamp] */
function addRaised(builder, outline, high, color, lamp = 0) {
  const top = outline.map(([x, y]) => builder.corner([x, y, HEIGHT_M + high], [0, 0, 1], color, { lamp }));
  for (let at = 2; at < top.length; at++) builder.triangle(top[0], top[at - 1], top[at]);
  const shade = color.map((value) => 0.9 * value);
  outline.forEach(([x, y], at) => {
    const [nextX, nextY] = outline[(at + 1) % outline.length];
    const long = Math.hypot(nextX - x, nextY - y);
    const normal = [(nextY - y) / long, (x - nextX) / long, 0];
    /** @param {number} px @param {number} py @param {number} z */
    const corner = (px, py, z) => builder.corner([px, py, z], normal, shade, { lamp });
    const bottom = [corner(x, y, HEIGHT_M), corner(nextX, nextY, HEIGHT_M)];
    builder.quad(bottom[0], bottom[1], corner(nextX, nextY, HEIGHT_M + high), corner(x, y, HEIGHT_M + high));
  });
}

/** @param {number} x @param {number} y @param {number} radius @param {number} sides @returns {[number, number][]} */
function round(x, y, radius, sides) {
  return Array.from({ length: sides }, (_, at) => {
    const angle = (2 * Math.PI * at) / sides;
    return [x + radius * Math.cos(angle), y + radius * Math.sin(angle)];
  });
}

/** @param {Builder} builder */
function addStuds(builder) {
  for (const y of STUDS.y) for (const x of STUDS.x) addRaised(builder, round(x, y, STUDS.radius, 6), STUDS.high, STUD);
}

/** @param {Builder} builder */
function addButtons(builder) {
  for (const [name, { x, y }] of Object.entries(BUTTON_PLACES)) {
    const lamp = LAMP_COLUMNS.get(name);
    if (!(name in HEADINGS)) {
      addRaised(builder, round(x, y, 0.0046, 12), BUTTON_M, BUTTON, lamp);
      continue;
    }
    const heading = (HEADINGS[name] * Math.PI) / 180;
    const [cos, sin] = [Math.cos(heading), Math.sin(heading)];
    const outline = /** @type {[number, number][]} */ ([
      [0.005, 0],
      [-0.0032, 0.0052],
      [-0.0032, -0.0052],
    ]).map(([along, across]) => /** @type {[number, number]} */ ([
      x + along * cos - across * sin,
      y + along * sin + across * cos,
    ]));
    addRaised(builder, outline, BUTTON_M, BUTTON, lamp);
  }
}

/** The circle of lights around the buttons: eight segments. @param {Builder} builder */
function addRing(builder) {
  for (const { name, place } of LIGHTS.filter(({ group }) => group === "circle")) {
    const middle = Math.atan2(place.y, place.x - RING.x);
    const half = Math.PI / 8 - RING.gap;
    const shape = new THREE.RingGeometry(RING.inner, RING.outer, 3, 1, middle - half, 2 * half);
    builder.add(shape.translate(RING.x, 0, TOP_M), UNLIT_RING, LAMP_COLUMNS.get(name));
  }
}

/** @param {Builder} builder @param {import("./parts.js").Light} light @param {number} radius @param {number} sides @param {readonly number[]} unlit */
function addLight(builder, { name, place, normal }, radius, sides, unlit) {
  const facing = new THREE.Quaternion().setFromUnitVectors(UP, new THREE.Vector3(normal.x, normal.y, normal.z));
  const shape = new THREE.CircleGeometry(radius, sides).applyQuaternion(facing);
  builder.add(shape.translate(place.x, place.y, place.z), unlit, LAMP_COLUMNS.get(name));
}

/** The two colored lights low on the sides. @param {Builder} builder @param {readonly number[]} unlit */
function addStrips(builder, unlit) {
  for (const [name, sign] of /** @type {const} */ ([
    ["bottom_left", 1],
    ["bottom_right", -1],
  ])) {
    const { x, z } = RGB_LIGHTS[name];
    const shape = new THREE.PlaneGeometry(0.022, 0.0044).rotateX((-sign * Math.PI) / 2);
    builder.add(shape.translate(x, sign * 0.0563, z), unlit, LAMP_COLUMNS.get(name));
  }
}
