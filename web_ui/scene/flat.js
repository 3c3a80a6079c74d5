// The 2D view from above: for browsers without WebGL, after a lost WebGL context, and for slow machines. It uses a
// camera like the 3D view, so that pointers, labels and ghosts work the same way.

import * as THREE from "three";

import { placed } from "../move/placed_bodies.js";
import { ROBOT_OUTLINE } from "../playground/robot_outline.js";
import { hasPicture, MARKER } from "../state/markers.js";
import { yawOf } from "../state/robot.js";
import { DESK, groundColor, wallColor } from "./colors.js";
import { LIGHT } from "./lights.js";
import { poseAt } from "./motion.js";
import { BUTTON_PLACES, LIDAR_PLACE, LIGHTS, PROXIMITY_PLACES } from "./parts.js";
import { MAX_RANGE_M } from "./rays.js";
import { HEAD, scanEnds } from "./scan.js";
import { drawSketch } from "./sketch.js";

/** @typedef {import("../state/index.js").State} State */
/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("../state/robot.js").Robot} Robot */

const MARGIN = 1.06;
/** The world gets this part of the picture at least. */
const LEAST_PART = 0.2;
const ZOOM_STEP = 1.15;
const FOLLOW_M = 0.9; // height of the visible area while following a robot
const ABOVE_M = 5;
const HALF_BEAM = 0.15; // rad
const DOT_M = 0.008; // where a beam of a lidar ended
const WHITE = [252, 250, 246];

export class FlatView {
  /** @param {HTMLCanvasElement} canvas  canvas over the 3D canvas */
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.camera = new THREE.OrthographicCamera(-1, 1, 1, -1, 0.01, 2 * ABOVE_M);
    this.camera.position.set(0, 0, ABOVE_M);
    this.zoom = 1;
    /** Pixels per CSS pixel. */
    this.pixelRatio = 1;
    /** @type {Map<Marker, ImageBitmap | null>} images on the ground; null while they are decoded */
    this.pictures = new Map();
  }

  /**
   * Show the whole world, or the area around a robot, in what is not covered.
   *
   * @param {THREE.Vector3[]} corners
   * @param {{ x: number, y: number } | null} followed
   * @param {import("./camera.js").Insets} [covered]   CSS pixels at the edges
   */
  aim(corners, followed, { top = 0, right = 0, bottom = 0, left = 0 } = {}) {
    const { width, height: high } = this.#size;
    const aspect = width / Math.max(1, high);
    const part = {
      width: Math.max(LEAST_PART, 1 - ((left + right) * this.pixelRatio) / Math.max(1, width)),
      height: Math.max(LEAST_PART, 1 - ((top + bottom) * this.pixelRatio) / Math.max(1, high)),
    };
    const box = new THREE.Box3().setFromPoints(corners.length > 0 ? corners : [new THREE.Vector3()]);
    const size = box.getSize(new THREE.Vector3());
    const middle = box.getCenter(new THREE.Vector3());
    const whole = MARGIN * Math.max(size.y / part.height, size.x / aspect / part.width, 0.2);
    const height = followed !== null ? FOLLOW_M : whole;
    const half = height / 2 / this.zoom;
    const pixel = ((2 * half) / Math.max(1, high)) * this.pixelRatio;
    const middleOf = followed ?? middle;
    const x = middleOf.x + ((right - left) / 2) * pixel;
    const y = middleOf.y + ((top - bottom) / 2) * pixel;
    Object.assign(this.camera, { left: -half * aspect, right: half * aspect, top: half, bottom: -half });
    this.camera.position.set(x, y, ABOVE_M);
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
  }

  /**
   * @param {State} state
   * @param {object} options
   * @param {number} options.nowMs
   * @param {(name: string) => boolean} options.senses  whether the beams of a robot are drawn
   * @param {import("../move/drag_controller.js").Dragged | null} options.held
   * @param {import("../creator/sketch.js").Sketch | null} options.sketch
   * @param {(name: string) => string} options.color
   * @param {() => void} options.changed   called when an image has been decoded
   */
  draw(state, { nowMs, senses, held, sketch, color, changed }) {
    const { context, canvas, camera } = this;
    if (context === null) return;
    Object.assign(canvas, this.#size);
    context.fillStyle = DESK.getStyle();
    context.fillRect(0, 0, canvas.width, canvas.height);
    const scale = canvas.height / (camera.top - camera.bottom);
    const { x, y } = camera.position;
    // From here on in meters, y up.
    context.setTransform(scale, 0, 0, -scale, canvas.width / 2 - x * scale, canvas.height / 2 + y * scale);
    const shown = [state.markers, state.objects, state.missionMarkers].flatMap((markers) => [...markers.values()]);
    const lowFirst = shown.sort((a, b) => top(a) - top(b));
    for (const marker of lowFirst) this.#marker(context, marker, changed);
    for (const robot of Object.values(state.robots)) {
      for (const stroke of robot.trail.values()) this.#marker(context, stroke, changed);
    }
    for (const [name, robot] of Object.entries(state.robots)) {
      if (robot.latest === null) continue;
      const { pose } = poseAt(robot.previous, robot.latest, nowMs);
      context.save();
      context.translate(pose.x, pose.y);
      context.rotate(pose.yaw);
      drawRobot(context, robot, senses(name), color(name));
      context.restore();
    }
    dim(context);
    if (held !== null) {
      context.fillStyle = held.blocker === null ? "rgb(75 67 184 / 50%)" : "rgb(179 38 30 / 60%)";
      for (const polygon of placed(held.body.outline, held.pose)) fill(context, polygon);
    }
    if (sketch !== null) drawSketch(context, sketch, this.pixelRatio / scale);
    context.setTransform(1, 0, 0, 1, 0, 0);
  }

  /** Zoom in or out. @param {number} steps */
  zoomBy(steps) {
    this.zoom = Math.min(8, Math.max(0.5, this.zoom * ZOOM_STEP ** steps));
  }

  /** The size of one CSS pixel in meters. */
  get pixelSize() {
    return ((this.camera.top - this.camera.bottom) * this.pixelRatio) / Math.max(1, this.#size.height);
  }

  /** The displayed size of the canvas in pixels; its own size if it is not displayed. */
  get #size() {
    const { clientWidth, clientHeight, width, height } = this.canvas;
    if (clientWidth === 0) return { width, height };
    return {
      width: Math.round(clientWidth * this.pixelRatio),
      height: Math.round(clientHeight * this.pixelRatio),
    };
  }

  /** @param {CanvasRenderingContext2D} context @param {Marker} marker @param {() => void} changed */
  #marker(context, marker, changed) {
    const { type, pose, scale, color, points, colors } = marker;
    context.save();
    context.translate(pose.position.x, pose.position.y);
    context.rotate(yawOf(pose.orientation));
    const isSolid = marker.ns.startsWith("solid/");
    context.fillStyle = context.strokeStyle = isSolid ? css(wallColor(color), color.a) : css(groundColor(color), color.a);
    const picture = hasPicture(marker) ? this.#picture(marker, changed) : null;
    if (picture !== null) {
      context.scale(1, -1);
      context.drawImage(picture, -scale.x / 2, -scale.y / 2, scale.x, scale.y);
    } else if (type === MARKER.CUBE) context.fillRect(-scale.x / 2, -scale.y / 2, scale.x, scale.y);
    else if (type === MARKER.CYLINDER || type === MARKER.SPHERE) disc(context, 0, 0, scale.x / 2);
    else if (type === MARKER.LINE_STRIP) {
      context.lineWidth = scale.x;
      context.lineCap = context.lineJoin = "round";
      context.beginPath();
      for (const point of points) context.lineTo(point.x, point.y);
      context.stroke();
    } else if (type === MARKER.TRIANGLE_LIST) {
      context.beginPath();
      for (let at = 0; at + 2 < points.length; at += 3) {
        if (colors.length > 0) {
          context.fill();
          context.beginPath();
          context.fillStyle = css(groundColor(colors[at]), colors[at].a);
        }
        const [a, b, c] = points.slice(at, at + 3);
        context.moveTo(a.x * scale.x, a.y * scale.y);
        context.lineTo(b.x * scale.x, b.y * scale.y);
        context.lineTo(c.x * scale.x, c.y * scale.y);
        context.closePath();
      }
      context.fill();
    }
    context.restore();
  }

  /** @param {Marker} marker @param {() => void} changed */
  #picture(marker, changed) {
    if (marker.texture?.image !== undefined) return marker.texture.image;
    const known = this.pictures.get(marker);
    if (known !== undefined) return known;
    this.pictures.set(marker, null);
    const png = new Blob([Uint8Array.from(marker.texture?.data ?? [])], { type: "image/png" });
    createImageBitmap(png).then(
      (bitmap) => {
        this.pictures.set(marker, bitmap);
        changed();
      },
      () => {}, // drawn as the mosaic of its triangles
    );
    return null;
  }
}

/** @param {Marker} marker */
function top({ pose, scale, type }) {
  return pose.position.z + (type === MARKER.TRIANGLE_LIST ? 0 : scale.z / 2);
}

/** @param {CanvasRenderingContext2D} context @param {Robot} robot @param {boolean} sensors @param {string} color */
function drawRobot(context, robot, sensors, color) {
  if (sensors) {
    for (const [name, { x, y, yaw }] of Object.entries(PROXIMITY_PLACES)) {
      const range = robot.proximity[name];
      if (range === undefined) continue;
      const seen = Number.isFinite(range) || range === -Infinity;
      const length = seen ? Math.max(range, 0.004) : MAX_RANGE_M;
      context.fillStyle = seen ? "rgb(239 125 46 / 65%)" : "rgb(239 125 46 / 18%)";
      context.beginPath();
      context.moveTo(x, y);
      context.arc(x, y, length, yaw - HALF_BEAM, yaw + HALF_BEAM);
      context.fill();
    }
    context.fillStyle = "rgb(239 125 46)";
    const ends = robot.scan === null ? [] : scanEnds(robot.scan);
    for (let at = 0; at < ends.length; at += 2)
      context.fillRect(ends[at] - DOT_M / 2, ends[at + 1] - DOT_M / 2, DOT_M, DOT_M);
  }
  const lit = robot.leds.top ?? [0, 0, 0];
  const most = Math.max(...lit);
  const [r, g, b] = lit.map((level, at) => WHITE[at] + (most > 0 ? 0.45 * most * (255 * (level / most) - WHITE[at]) : 0));
  context.fillStyle = `rgb(${r} ${g} ${b})`;
  context.strokeStyle = color;
  context.lineWidth = 0.004;
  fill(context, ROBOT_OUTLINE);
  context.stroke();
  context.fillStyle = "#45403b";
  for (const side of [1, -1]) context.fillRect(-0.022, side * 0.047 - 0.0075, 0.044, 0.015);
  if (robot.hasLidar) {
    context.fillStyle = `#${HEAD.color.toString(16)}`;
    disc(context, LIDAR_PLACE.x, LIDAR_PLACE.y, HEAD.radius);
  }
  for (const [name, { x, y }] of Object.entries(BUTTON_PLACES)) {
    context.fillStyle = robot.buttons[name] ? "#25225c" : "#99948d";
    disc(context, x, y, 0.005);
  }
  for (const { group, index, place, color: full, normal } of LIGHTS) {
    const level = robot.leds[group]?.[index] ?? 0;
    if (level === 0) continue;
    context.fillStyle = `#${full.toString(16).padStart(6, "0")}`;
    context.globalAlpha = 0.3 + 0.7 * level;
    disc(context, place.x - 0.006 * normal.x, place.y - 0.006 * normal.y, 0.0035);
    context.globalAlpha = 1;
  }
}

/** @param {CanvasRenderingContext2D} context @param {readonly (readonly [number, number])[]} polygon */
function fill(context, polygon) {
  context.beginPath();
  for (const [x, y] of polygon) context.lineTo(x, y);
  context.closePath();
  context.fill();
}

/** @param {CanvasRenderingContext2D} context @param {number} x @param {number} y @param {number} radius */
function disc(context, x, y, radius) {
  context.beginPath();
  context.arc(x, y, radius, 0, 2 * Math.PI);
  context.fill();
}

/** @param {THREE.Color} color @param {number} opacity */
function css({ r, g, b }, opacity) {
  return `rgb(${r * 255} ${g * 255} ${b * 255} / ${opacity})`;
}

/** The evening of the dark theme. @param {CanvasRenderingContext2D} context */
function dim(context) {
  const color = LIGHT.uDim.value;
  if (color.r === 1) return;
  context.save();
  context.setTransform(1, 0, 0, 1, 0, 0);
  context.globalCompositeOperation = "multiply";
  context.fillStyle = css(color, 1);
  context.fillRect(0, 0, context.canvas.width, context.canvas.height);
  context.restore();
}
