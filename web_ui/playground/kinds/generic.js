// Approximate primitives of a kind that the page knows only by its declaration: from its center or path, and from the
// fields that name a size.

import { circle, placed, rectangle } from "../geometry.js";
import { boxSolid, discSolid } from "../primitives.js";

/** @typedef {import("../geometry.js").Point} Point */
/** @typedef {import("../geometry.js").Pose} Pose */

const DEFAULT_SIZE_M = 0.1;
const DEFAULT_WIDTH_M = 0.02;
const DEFAULT_COLOR = "#9fa3bd";
const LENGTHS = ["size_x_m", "length_m", "side_m", "diameter_m"];
const WIDTHS = ["size_y_m", "width_m", "thickness_m", "side_m", "diameter_m"];

/** @param {Omit<import("./index.js").Kind, "draw" | "isExact">} kind @returns {import("./index.js").Draw} */
export function genericDraw({ group, fields, points, path, placement }) {
  const colorKey = Object.keys(fields).find((key) => fields[key].format === "color");
  const [centerX, centerY] = points[0] ?? [];
  return (values) => {
    const color = values[colorKey ?? ""] ?? DEFAULT_COLOR;
    const height = values.height_m ?? DEFAULT_SIZE_M;
    /** @param {Pose} pose @param {number} sizeX @param {number} sizeY @returns {import("../primitives.js").Primitive} */
    const box = (pose, sizeX, sizeY) => {
      if (group === "object") return boxSolid(pose, sizeX, sizeY, height, color);
      return { type: group === "ground" ? "floor" : "paint", vertices: placed(pose, rectangle(sizeX, sizeY)), color };
    };
    const width = first(values, WIDTHS) ?? DEFAULT_WIDTH_M;
    if (placement === "ends")
      return [along([values.start_x_m, values.start_y_m], [values.end_x_m, values.end_y_m], width, box)];
    if (placement === "path") {
      const corners = /** @type {Point[]} */ (values[path ?? ""] ?? []);
      return corners.slice(1).map((corner, index) => along(corners[index], corner, width, box));
    }
    const pose = { x: values[centerX ?? ""] ?? 0, y: values[centerY ?? ""] ?? 0, yaw: values.yaw_rad ?? 0 };
    const length = first(values, LENGTHS);
    const { radius_m: radius } = values;
    if (length === undefined && typeof radius === "number") {
      if (group === "object") return [discSolid(pose, radius, height, color)];
      return [{ type: group === "ground" ? "floor" : "paint", vertices: placed(pose, circle(radius)), color }];
    }
    return [box(pose, length ?? DEFAULT_SIZE_M, first(values, WIDTHS) ?? DEFAULT_SIZE_M)];
  };
}

/** The first of some values that is a number. @param {Record<string, any>} values @param {readonly string[]} keys @returns {number | undefined} */
function first(values, keys) {
  return keys.map((key) => values[key]).find((value) => typeof value === "number");
}

/**
 * A part of a width from one point to another.
 *
 * @template T
 * @param {Point} from
 * @param {Point} to
 * @param {number} width
 * @param {(pose: Pose, sizeX: number, sizeY: number) => T} box
 */
function along([ax, ay], [bx, by], width, box) {
  const [dx, dy] = [bx - ax, by - ay];
  return box({ x: ax + dx / 2, y: ay + dy / 2, yaw: Math.atan2(dy, dx) }, Math.hypot(dx, dy) + width, width);
}
