// The drawing of a kind of shape: the primitives that the simulator has computed for its values. Until they arrive, those
// of similar values, stretched as the fields that name a size differ; or strips along the points of the shape.

import { BUILT_IN } from "../declarations.js";
import { inFrame, placed, rectangle } from "../geometry.js";
import { boxSolid } from "../primitives.js";
import { Fault, filled } from "../rules.js";

/** @typedef {import("../geometry.js").Point} Point */
/** @typedef {import("../geometry.js").Pose} Pose */
/** @typedef {import("../primitives.js").Primitive} Primitive */
/** @typedef {Omit<import("./index.js").Kind, "shape">} KindFields */
/** @typedef {Record<string, any>} Values */
/** @typedef {{ primitives?: Primitive[], fault?: { key: string, found: string, word: string } }} Answer  of the simulator */
/** @typedef {{ primitives: Primitive[], isKnown: boolean, fault: Fault | null }} Drawing  isKnown: the simulator has answered */

const ORIGIN = { x: 0, y: 0, yaw: 0 };
const DEFAULT_SIZE_M = 0.1;
const DEFAULT_WIDTH_M = 0.02;
const DEFAULT_COLOR = "#9fa3bd";
/** Fields that are a size along x, along y, and along z, of which the first that a kind has counts. */
const LENGTHS = ["size_x_m", "length_m", "side_m", "diameter_m", "radius_m", "unit_m"];
const WIDTHS = ["size_y_m", "width_m", "thickness_m", "side_m", "diameter_m", "radius_m", "unit_m"];
const HEIGHTS = ["height_m"];
/** Stands for an image in a request: the simulator reads none. */
const IMAGE = "data:";
/** Relative positions are rounded to this part of a meter, so that a moved item has the same values. */
const RESOLUTION = 1e9;
const FAR_M = BUILT_IN.coordinate.high ?? Infinity;
/** More than the shapes of a playground. */
const MOST_ANSWERS = 4 * BUILT_IN.limits.shapes;
/** Number of the latest answers of which the most similar one is stretched. */
const COMPARED = 20;

/** Number of answers so far: what was derived from previews is out of date when it changes. */
export let answerCount = 0;
/** Whether the simulator has answered the last request. */
let isAnswering = false;
/** @type {Answer & { values: Values }} */ const NONE = { values: {} };

/** Call when the simulator has not answered. */
export function noteSilence() {
  if (isAnswering) answerCount++;
  isAnswering = false;
}

export class GenericShape {
  /** @param {KindFields} kind @param {Primitive[]} primitives  of the sample at the origin */
  constructor(kind, primitives) {
    this.kind = kind;
    /** @type {Map<string, Answer & { values: Values }>} by request */ this.answers = new Map();
    this.colorKey = Object.keys(kind.fields).find((key) => kind.fields[key].format === "color") ?? "";
    const sample = filled(kind.fields, { ...kind.sample, x_m: 0, y_m: 0, yaw_rad: 0 });
    const { frame, request } = this.framed(sample);
    if (primitives.length > 0 && isSame(frame, ORIGIN)) this.answers.set(request, { primitives, values: JSON.parse(request) });
  }

  /**
   * The frame of an item, and its values in that frame as a request to the simulator. Moved items have the same request,
   * also turned ones if they have a rotation.
   *
   * @param {Values} values
   * @returns {{ frame: Pose, own: Values, request: string }}
   */
  framed(values) {
    const { name, fields, points, path = "", isRelative, placement } = this.kind;
    const turns = placement === "center" && points.length > 0 && "yaw_rad" in fields;
    /** @param {Pose} frame @returns {Values} */
    const seenFrom = (frame) => {
      /** @param {Point} point */
      const local = (point) => inFrame(frame, point).map((one) => Math.round(one * RESOLUTION) / RESOLUTION + 0);
      const hidden = (/** @type {string} */ key) => fields[key].type === "image" && (values[key] ?? null) !== null;
      const own = Object.fromEntries(Object.keys(fields).map((key) => [key, hidden(key) ? IMAGE : values[key]]));
      if (turns) own.yaw_rad = values.yaw_rad - frame.yaw;
      for (const [keyX, keyY] of points) [own[keyX], own[keyY]] = local([values[keyX], values[keyY]]);
      if (!isRelative && path in values) own[path] = values[path].map(local);
      return own;
    };
    const [x, y] = points.length > 0 ? points[0].map((key) => values[key]) : (values[path]?.[0] ?? [0, 0]);
    let frame = { x, y, yaw: turns ? values.yaw_rad : 0 };
    // A distance may be larger than a coordinate.
    if (Object.values(seenFrom(frame)).flat(2).some((one) => Math.abs(one) > FAR_M)) frame = ORIGIN;
    const own = seenFrom(frame);
    return { frame, own, request: JSON.stringify({ kind: name, ...own }) };
  }

  /** Keep an answer of the simulator. @param {string} request @param {Answer} answer */
  learn(request, answer) {
    this.answers.set(request, { ...answer, values: JSON.parse(request) });
    if (this.answers.size > MOST_ANSWERS) this.answers.delete([...this.answers.keys()][0]);
    answerCount++;
    isAnswering = true;
  }

  /** @param {Values} values @returns {Drawing} */
  draw(values) {
    const { frame, own, request } = this.framed(values);
    const answer = this.answers.get(request);
    const primitives = (answer?.primitives ?? this.#preview(own)).map((part) => placedPart(part, frame, values));
    const { key, found, word } = answer?.fault ?? {};
    const fault = key === undefined ? null : new Fault(key, found ?? "", { word: `fault.${word || "other"}` });
    return { primitives, isKnown: answer !== undefined, fault };
  }

  /** @param {Values} own @returns {Primitive[]} */
  #preview(own) {
    const { placement, path = "" } = this.kind;
    if (placement === "center") return this.#stretched(own);
    const corners = placement === "ends" ? endsOf(own) : /** @type {Point[]} */ (own[path] ?? []);
    const { primitives = [], values } = this.#mostSimilar(own);
    // More than strips, such as rounded corners: these stay while an answer is on its way.
    if (isAnswering && primitives.length >= corners.length && values[path]?.length === corners.length) return primitives;
    return corners.slice(1).map((corner, index) => this.#strip(own, corners[index], corner));
  }

  /** The primitives of the most similar shape, with the sizes and the color of this one. @param {Values} own @returns {Primitive[]} */
  #stretched(own) {
    const { primitives = [], values } = this.#mostSimilar(own);
    if (primitives.length === 0) return [this.#part(own, ORIGIN, sizeOf(LENGTHS, own), sizeOf(WIDTHS, own))];
    const [x, y, z] = [LENGTHS, WIDTHS, HEIGHTS].map((keys) => ratio(keys, own, values));
    return primitives.map((part) => {
      const color = "color" in part && part.color === values[this.colorKey] ? { color: this.#color(own) } : {};
      return { ...stretchedPart(part, x, y, z), ...color };
    });
  }

  /** The latest answer with the fewest other values; without primitives if there is none. @param {Values} own */
  #mostSimilar(own) {
    const latest = [...this.answers.values()].filter(({ primitives }) => primitives !== undefined).slice(-COMPARED);
    /** @param {Values} values */
    const differing = (values) => Object.keys(own).filter((key) => !isSame(own[key], values[key])).length;
    return latest.reverse().sort((one, other) => differing(one.values) - differing(other.values))[0] ?? NONE;
  }

  /** @param {Values} own @param {Point} from @param {Point} to */
  #strip(own, [ax, ay], [bx, by]) {
    const width = sizeOf(WIDTHS, own, DEFAULT_WIDTH_M);
    const [dx, dy] = [bx - ax, by - ay];
    const pose = { x: ax + dx / 2, y: ay + dy / 2, yaw: Math.atan2(dy, dx) };
    const beyond = this.kind.placement === "ends" ? width : 0; // so that the corners of walls close
    return this.#part(own, pose, Math.hypot(dx, dy) + beyond, width);
  }

  /**
   * @param {Values} own
   * @param {Pose} pose
   * @param {number} sizeX
   * @param {number} sizeY
   * @returns {Primitive}
   */
  #part(own, pose, sizeX, sizeY) {
    const color = this.#color(own);
    const { group } = this.kind;
    if (group === "object") return boxSolid(pose, sizeX, sizeY, sizeOf(HEIGHTS, own), color);
    return { type: group === "ground" ? "floor" : "paint", vertices: placed(pose, rectangle(sizeX, sizeY)), color };
  }

  /** @param {Values} own @returns {string} */
  #color(own) {
    return own[this.colorKey] ?? DEFAULT_COLOR;
  }
}

/** The first size that a shape has. @param {readonly string[]} keys @param {Values} own @param {number} [usual] @returns {number} */
function sizeOf(keys, own, usual = DEFAULT_SIZE_M) {
  return keys.map((key) => own[key]).find((size) => typeof size === "number") ?? usual;
}

/** How much larger a shape is than another one. @param {readonly string[]} keys @param {Values} own @param {Values} other */
function ratio(keys, own, other) {
  const found = sizeOf(keys, own) / sizeOf(keys, other);
  return Number.isFinite(found) && found > 0 ? found : 1;
}

/** @param {Primitive} part @param {number} x @param {number} y @param {number} z @returns {Primitive} */
function stretchedPart(part, x, y, z) {
  const { pose, size, vertices, radius, height, sizeX, sizeY } = /** @type {any} */ (part);
  /** @param {Point} point @returns {Point} */
  const larger = ([u, v]) => [x * u, y * v];
  return {
    ...part,
    ...(pose && { pose: { ...pose, x: x * pose.x, y: y * pose.y } }),
    ...(size && { size: larger(size) }),
    ...(vertices && { vertices: vertices.map(larger) }),
    ...(radius && { radius: x * radius }),
    ...(height && { height: z * height }),
    ...(sizeX && { sizeX: x * sizeX, sizeY: sizeY && y * sizeY }),
  };
}

/** A part in the frame of the world, with the image of the item. @param {Primitive} part @param {Pose} frame @param {Values} values @returns {Primitive} */
function placedPart(part, frame, values) {
  if ("pose" in part) {
    const [[x, y]] = placed(frame, [[part.pose.x, part.pose.y]]);
    const pose = { x, y, yaw: frame.yaw + part.pose.yaw };
    return part.type === "print" ? { ...part, pose, image: values[part.image] } : { ...part, pose };
  }
  return { ...part, vertices: placed(frame, part.vertices) };
}

/** @param {Values} values @returns {Point[]} */
function endsOf({ start_x_m, start_y_m, end_x_m, end_y_m }) {
  return [[start_x_m, start_y_m], [end_x_m, end_y_m]]; // prettier-ignore
}

/** @param {unknown} one @param {unknown} other */
function isSame(one, other) {
  return one === other || JSON.stringify(one) === JSON.stringify(other);
}
