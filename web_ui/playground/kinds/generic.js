// The drawing of a kind that the page knows only by its declaration: the primitives of its sample, which the simulator
// has computed; for other values a box that grows with the fields that name a size.

import { placed, rectangle } from "../geometry.js";
import { boxSolid, footprintOf } from "../primitives.js";

/** @typedef {import("../geometry.js").Point} Point */
/** @typedef {import("../geometry.js").Pose} Pose */
/** @typedef {import("../primitives.js").Primitive} Primitive */
/** @typedef {Omit<import("./index.js").Kind, "draw" | "isExact">} KindFields */
/** @typedef {{ left: number, right: number, bottom: number, top: number }} Bounds  in the frame of the item */

const DEFAULT_SIZE_M = 0.1;
const DEFAULT_WIDTH_M = 0.02;
const DEFAULT_COLOR = "#9fa3bd";
/** Fields that are a size along x, and along y, of which the first that a kind has counts. */
const LENGTHS = ["size_x_m", "length_m", "side_m", "diameter_m", "radius_m", "unit_m"];
const WIDTHS = ["size_y_m", "width_m", "thickness_m", "side_m", "diameter_m", "radius_m", "unit_m"];

export class GenericShape {
  /** @param {KindFields} kind @param {readonly Primitive[]} primitives  of the sample, whose coordinates are 0 */
  constructor(kind, primitives) {
    this.kind = kind;
    this.primitives = primitives;
    this.bounds = boundsOf(primitives);
    const [centerX, centerY] = kind.points[0] ?? [];
    this.poseKeys = [centerX, centerY, "yaw_rad"];
    this.colorKey = Object.keys(kind.fields).find((key) => kind.fields[key].format === "color") ?? "";
    /** Values on which the primitives depend, except for pose and color. */
    this.shapeKeys = Object.keys(kind.fields).filter((key) => ![...this.poseKeys, this.colorKey].includes(key));
  }

  /** Whether an item differs from the sample at most in pose and color. @param {Record<string, any>} values */
  isSample(values) {
    const { sample, fields, placement } = this.kind;
    return (
      placement === "center" &&
      this.primitives.length > 0 &&
      this.shapeKeys.every((key) => isSame(values[key], sample[key] ?? fields[key].default))
    );
  }

  /** @param {Record<string, any>} values @returns {Primitive[]} */
  draw(values) {
    const { placement, path } = this.kind;
    if (placement === "center") {
      return this.isSample(values) ? this.#sample(values) : [this.#box(values)];
    }
    const corners = placement === "ends" ? endsOf(values) : /** @type {Point[]} */ (values[path ?? ""] ?? []);
    return corners.slice(1).map((corner, index) => this.#strip(values, corners[index], corner));
  }

  /** The sample at the pose and in the color of an item. @param {Record<string, any>} values @returns {Primitive[]} */
  #sample(values) {
    const frame = this.#poseOf(values);
    const { sample, fields } = this.kind;
    const old = sample[this.colorKey] ?? fields[this.colorKey]?.default;
    return this.primitives.map((part) => {
      const color = "color" in part && part.color !== old ? part.color : this.#color(values);
      if (part.type === "trigger") return { ...part, vertices: placed(frame, part.vertices) };
      if (part.type === "floor" || part.type === "paint") return { ...part, vertices: placed(frame, part.vertices), color };
      const [[x, y]] = placed(frame, [[part.pose.x, part.pose.y]]);
      return { ...part, pose: { x, y, yaw: frame.yaw + part.pose.yaw }, ...(part.type === "solid" ? { color } : {}) };
    });
  }

  /**
   * The bounds of the sample, stretched as the sizes of an item differ from those of the sample.
   *
   * @param {Record<string, any>} values
   */
  #box(values) {
    const { left, right, bottom, top } = this.bounds;
    const [stretchX, stretchY] = [this.#stretch(LENGTHS, values), this.#stretch(WIDTHS, values)];
    const [x, y] = [(stretchX * (left + right)) / 2, (stretchY * (bottom + top)) / 2];
    const frame = this.#poseOf(values);
    const [[centerX, centerY]] = placed(frame, [[x, y]]);
    return this.#part(values, { x: centerX, y: centerY, yaw: frame.yaw }, stretchX * (right - left), stretchY * (top - bottom));
  }

  /** @param {Record<string, any>} values @param {Point} from @param {Point} to */
  #strip(values, [ax, ay], [bx, by]) {
    const width = WIDTHS.map((key) => values[key]).find((value) => typeof value === "number") ?? DEFAULT_WIDTH_M;
    const [dx, dy] = [bx - ax, by - ay];
    const pose = { x: ax + dx / 2, y: ay + dy / 2, yaw: Math.atan2(dy, dx) };
    return this.#part(values, pose, Math.hypot(dx, dy) + width, width);
  }

  /**
   * @param {Record<string, any>} values
   * @param {Pose} pose
   * @param {number} sizeX
   * @param {number} sizeY
   * @returns {Primitive}
   */
  #part(values, pose, sizeX, sizeY) {
    const color = this.#color(values);
    const { group } = this.kind;
    if (group === "object") return boxSolid(pose, sizeX, sizeY, values.height_m ?? DEFAULT_SIZE_M, color);
    return { type: group === "ground" ? "floor" : "paint", vertices: placed(pose, rectangle(sizeX, sizeY)), color };
  }

  /** @param {readonly string[]} keys @param {Record<string, any>} values */
  #stretch(keys, values) {
    const { sample, fields } = this.kind;
    const key = keys.find((one) => fields[one]?.type === "number");
    if (key === undefined) return 1;
    const ratio = values[key] / (sample[key] ?? fields[key].default);
    return Number.isFinite(ratio) && ratio > 0 ? ratio : 1;
  }

  /** @param {Record<string, any>} values @returns {string} */
  #color(values) {
    return values[this.colorKey] ?? DEFAULT_COLOR;
  }

  /** @param {Record<string, any>} values @returns {Pose} */
  #poseOf(values) {
    const [x, y, yaw] = this.poseKeys.map((key) => values[key ?? ""] ?? 0);
    return { x, y, yaw };
  }
}

/** @param {readonly Primitive[]} primitives @returns {Bounds} */
function boundsOf(primitives) {
  const corners = primitives.flatMap((part) => {
    if (part.type === "floor" || part.type === "paint") return part.vertices;
    if (part.type !== "solid") return [];
    const footprint = footprintOf(part);
    if ("vertices" in footprint) return [...footprint.vertices];
    return placed(part.pose, rectangle(2 * footprint.radius, 2 * footprint.radius));
  });
  if (corners.length === 0) corners.push(...rectangle(DEFAULT_SIZE_M, DEFAULT_SIZE_M));
  const [xs, ys] = [corners.map(([x]) => x), corners.map(([, y]) => y)];
  return { left: Math.min(...xs), right: Math.max(...xs), bottom: Math.min(...ys), top: Math.max(...ys) };
}

/** @param {Record<string, any>} values @returns {Point[]} */
function endsOf({ start_x_m, start_y_m, end_x_m, end_y_m }) {
  return [[start_x_m, start_y_m], [end_x_m, end_y_m]]; // prettier-ignore
}

/** @param {unknown} one @param {unknown} other */
function isSame(one, other) {
  return one === other || JSON.stringify(one) === JSON.stringify(other);
}
