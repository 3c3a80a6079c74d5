// A playground as markers, as the simulator publishes them, so that one scene draws running and edited worlds.

import { MARKER } from "../state/markers.js";
import { partsOf } from "./parts.js";

/** @typedef {import("../state/markers.js").Marker} Marker */
/** @typedef {import("./parts.js").Item} Item */
/** @typedef {import("./geometry.js").Point} Point */
/** @typedef {import("./primitives.js").Primitive} Primitive */
/** @typedef {{ image: ImageBitmap | HTMLCanvasElement, width: number, height: number }} Picture */

/** Each layer of paint is this much above the previous one, as in the simulator's markers. */
const LAYER_M = 0.0002;

export class Markers {
  /** @param {(uri: string) => Picture | null} pictureOf  null while the image is loading */
  constructor(pictureOf) {
    this.pictureOf = pictureOf;
    /** @type {WeakMap<Item, { primitives: Primitive[], layer: number, pictures: string, markers: Marker[] }>} */ this.known = new WeakMap();
  }

  /**
   * Unchanged items keep their marker objects.
   *
   * @param {readonly Item[]} items
   * @returns {ReadonlyMap<string, Marker>}
   */
  of(items) {
    /** @type {Map<string, Marker>} */ const found = new Map();
    items.forEach((item, layer) => {
      for (const marker of this.#markersOf(item, layer)) found.set(`${marker.ns}/${marker.id}`, marker);
    });
    return found;
  }

  /** @param {Item} item @param {number} layer */
  #markersOf(item, layer) {
    const { primitives } = partsOf(item);
    const pictures = primitives.map((part) => part.type === "print" && this.pictureOf(part.image) !== null).join();
    const known = this.known.get(item);
    const isSame = known?.primitives === primitives && known.layer === layer && known.pictures === pictures;
    if (isSame) return known.markers;
    /** @type {Marker[]} */ const markers = [];
    const patches = primitives.flatMap((part) => (part.type === "floor" || part.type === "paint" ? [part] : []));
    if (patches.length > 0) markers.push(flat(item.name, patches, layer * LAYER_M));
    primitives.forEach((part, index) => {
      if (part.type === "solid") markers.push(solid(item.name, index + 1, part));
      else if (part.type === "print") {
        const picture = this.pictureOf(part.image);
        if (picture !== null) markers.push(print(item.name, index + 1, part, picture, layer * LAYER_M));
      }
    });
    this.known.set(item, { primitives, layer, pictures, markers });
    return markers;
  }
}

/** @param {string} name @param {import("./primitives.js").Patch[]} patches @param {number} z @returns {Marker} */
function flat(name, patches, z) {
  const points = patches.flatMap(({ vertices }) => fan(vertices, 0));
  return {
    ...marker(`${patches[0].type}/${name}`, 0, MARKER.TRIANGLE_LIST, patches[0].color),
    pose: pose(0, 0, z, 0),
    points,
  };
}

/** @param {string} name @param {number} id @param {import("./primitives.js").Solid} part @returns {Marker} */
function solid(name, id, { pose: { x, y, yaw }, size, radius = 0, vertices, height, color }) {
  if (vertices !== undefined) {
    const prism = marker(`solid/${name}`, id, MARKER.TRIANGLE_LIST, color);
    return { ...prism, pose: pose(x, y, height / 2, yaw), points: prismOf(vertices, height / 2) };
  }
  const [sizeX, sizeY] = size ?? [2 * radius, 2 * radius];
  const type = size === undefined ? MARKER.CYLINDER : MARKER.CUBE;
  return {
    ...marker(`solid/${name}`, id, type, color),
    pose: pose(x, y, height / 2, yaw),
    scale: { x: sizeX, y: sizeY, z: height },
  };
}

/** The triangles of a convex polygon. @param {readonly Point[]} vertices @param {number} z */
function fan(vertices, z) {
  return vertices
    .slice(2)
    .flatMap((third, index) => [vertices[0], vertices[index + 1], third].map(([x, y]) => ({ x, y, z })));
}

/** The triangles of the top and the sides of a prism. @param {readonly Point[]} vertices @param {number} half  of its height */
function prismOf(vertices, half) {
  const sides = vertices.flatMap(([bx, by], index) => {
    const [ax, ay] = vertices.at(index - 1) ?? [bx, by];
    return [[ax, ay, -half], [bx, by, -half], [bx, by, half], [ax, ay, -half], [bx, by, half], [ax, ay, half]]; // prettier-ignore
  });
  return [...fan(vertices, half), ...sides.map(([x, y, z]) => ({ x, y, z }))];
}

/**
 * @param {string} name
 * @param {number} id
 * @param {import("./primitives.js").Print} part
 * @param {Picture} picture
 * @param {number} z
 * @returns {Marker}
 */
function print(name, id, { pose: { x, y, yaw }, sizeX, sizeY }, { image, width, height }, z) {
  const scale = { x: sizeX, y: sizeY ?? (sizeX * height) / width, z: 1 };
  return {
    ...marker(`paint/${name}`, id, MARKER.TRIANGLE_LIST, "#ffffff"),
    pose: pose(x, y, z, yaw),
    scale,
    texture: { data: [], image },
  };
}

/** @param {string} ns @param {number} id @param {number} type @param {string} color @returns {Marker} */
function marker(ns, id, type, color) {
  const [r, g, b] = [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16) / 255);
  return {
    ns,
    id,
    type,
    action: 0,
    pose: pose(0, 0, 0, 0),
    scale: { x: 1, y: 1, z: 1 },
    color: { r, g, b, a: 1 },
    points: [],
    colors: [],
  };
}

/** @param {number} x @param {number} y @param {number} z @param {number} yaw */
function pose(x, y, z, yaw) {
  return { position: { x, y, z }, orientation: { x: 0, y: 0, z: Math.sin(yaw / 2), w: Math.cos(yaw / 2) } };
}
