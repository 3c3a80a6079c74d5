// Draws the playground from its markers: one mesh each, identified by namespace and id, replaced when it changes.

import * as THREE from "three";

import { groundColor } from "./colors.js";
import { ContactShade } from "./contact.js";
import { litMaterial } from "./materials.js";
import { solidMesh } from "./solids.js";
import { STILL_LAYER } from "./still_ground.js";
import { hasPicture, MARKER } from "../state/markers.js";

/** @typedef {import("../state/markers.js").Marker} Marker */

/** One row per marker type: its geometry in its own frame, already scaled. */
const GEOMETRIES = /** @type {Record<number, (marker: Marker) => THREE.BufferGeometry>} */ ({
  [MARKER.CUBE]: ({ scale }) => new THREE.BoxGeometry(scale.x, scale.y, scale.z),
  [MARKER.SPHERE]: ({ scale }) =>
    new THREE.SphereGeometry(0.5, 24, 16).rotateX(Math.PI / 2).scale(scale.x, scale.y, scale.z),
  [MARKER.CYLINDER]: ({ scale }) =>
    new THREE.CylinderGeometry(0.5, 0.5, 1, 28).rotateX(Math.PI / 2).scale(scale.x, scale.y, scale.z),
  [MARKER.LINE_STRIP]: ribbon,
  [MARKER.TRIANGLE_LIST]: triangles,
});

export class PlaygroundModel {
  /**
   * @param {() => void} changed  called when an image has been decoded
   * @param {(png: Blob) => Promise<ImageBitmap>} decode  decodes an image, its last row first
   * @param {{ isStill?: boolean }} [how]   whether its ground rarely changes (still_ground.js)
   */
  constructor(
    changed = () => {},
    decode = (png) => createImageBitmap(png, { imageOrientation: "flipY" }),
    { isStill = false } = {},
  ) {
    this.changed = changed;
    this.isStill = isStill;
    this.decode = decode;
    this.group = new THREE.Group();
    /**
     * @type {Map<string, { marker: Marker, mesh: THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial> }>}
     */
    this.meshes = new Map();
    this.shade = new ContactShade();
    if (isStill) this.shade.mesh.layers.set(STILL_LAYER);
    /** @type {ReadonlyMap<string, Marker> | null} */ this.shown = null;
  }

  /** Update the meshes; returns whether anything changed. @param {ReadonlyMap<string, Marker>} markers */
  update(markers) {
    if (markers === this.shown) return false;
    this.shown = markers;
    for (const [key, entry] of [...this.meshes]) {
      const next = markers.get(key);
      if (next === entry.marker) continue;
      if (next !== undefined && (isSameSolid(entry.marker, next) || isSameStrip(entry.marker, next))) {
        entry.marker = next;
        place(entry.mesh, next);
      } else this.#remove(key);
    }
    for (const [key, marker] of markers) {
      if (!this.meshes.has(key) && marker.type in GEOMETRIES) this.#add(key, marker);
    }
    this.shade.update(markers.values());
    if (this.shade.mesh.visible) this.group.add(this.shade.mesh);
    else this.group.remove(this.shade.mesh);
    return true;
  }

  /** All corners in the world, for fitting the view. */
  corners() {
    /** @type {THREE.Vector3[]} */ const corners = [];
    for (const { mesh } of this.meshes.values()) {
      mesh.updateMatrixWorld();
      const { position } = mesh.geometry.attributes;
      for (let index = 0; index < position.count; index++) {
        corners.push(new THREE.Vector3().fromBufferAttribute(position, index).applyMatrix4(mesh.matrixWorld));
      }
    }
    return corners;
  }

  dispose() {
    for (const key of [...this.meshes.keys()]) this.#remove(key);
    this.shade.dispose();
  }

  /** @param {string} key @param {Marker} marker */
  #add(key, marker) {
    const mesh = hasPicture(marker) ? this.#pictured(marker) : this.#plain(marker);
    place(mesh, marker);
    if (this.isStill && isGround(marker)) mesh.layers.set(STILL_LAYER);
    this.meshes.set(key, { marker, mesh });
    this.group.add(mesh);
  }

  /** An image lies flat in the marker's frame; the scale gives its size. @param {Marker} marker */
  #pictured({ scale, texture }) {
    const map = new THREE.Texture();
    map.anisotropy = 8;
    const material = litMaterial({ map, flat: true, print: true, side: THREE.DoubleSide });
    material.visible = false;
    /** @param {ImageBitmap | HTMLCanvasElement} image */
    const show = (image) => {
      map.image = image;
      map.needsUpdate = material.visible = true;
    };
    if (texture?.image !== undefined) show(texture.image);
    else {
      map.flipY = false; // the bitmap is upside down
      const png = Uint8Array.from(texture?.data ?? []);
      this.decode(new Blob([png], { type: "image/png" })).then((bitmap) => {
        show(bitmap);
        this.changed();
      });
    }
    return new THREE.Mesh(new THREE.PlaneGeometry(scale.x, scale.y), material);
  }

  /** @param {Marker} marker */
  #plain(marker) {
    const geometry = GEOMETRIES[marker.type](marker);
    if (!isGround(marker)) return solidMesh(marker, geometry);
    const perPoint = marker.colors.length > 0;
    const color = perPoint ? new THREE.Color(0xffffff) : groundColor(marker.color);
    const opacity = marker.color.a;
    return new THREE.Mesh(
      geometry,
      litMaterial({ color, flat: true, vertexColors: perPoint, opacity, side: THREE.DoubleSide }),
    );
  }

  /** @param {string} key */
  #remove(key) {
    const entry = this.meshes.get(key);
    if (entry === undefined) return;
    this.group.remove(entry.mesh);
    entry.mesh.geometry.dispose();
    entry.mesh.material.uniforms.uMap.value?.dispose();
    entry.mesh.material.dispose();
    this.meshes.delete(key);
  }
}

/** Whether it is floor, paint, or a line of a pen: flat on the ground, seen by the ground sensors. @param {Marker} marker */
function isGround({ ns, type }) {
  return !ns.startsWith("solid/") && (type === MARKER.TRIANGLE_LIST || type === MARKER.LINE_STRIP);
}

/** Paint lies this much above the floor; `layered` decides what covers what. */
const PAINT_M = 0.0004;
const LOWER = 40;

/**
 * Paint and floors cover each other in the order of their heights, by drawing them one after another: so they can lie
 * closer together than the depth buffer distinguishes, and what stands on them does not sink in.
 *
 * @param {THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>} mesh
 * @param {Marker} marker
 */
function layered(mesh, { ns, pose: { position } }) {
  const isFloor = ns.startsWith("floor/");
  mesh.renderOrder = 10 + 1000 * position.z;
  mesh.material.depthWrite = isFloor;
  mesh.position.z = (isFloor ? 0 : PAINT_M) + Math.min(0.002, position.z / LOWER);
}

/** @param {THREE.Mesh<THREE.BufferGeometry, THREE.ShaderMaterial>} mesh @param {Marker} marker */
function place(mesh, marker) {
  const { position, orientation } = marker.pose;
  mesh.position.set(position.x, position.y, position.z);
  if (isGround(marker)) layered(mesh, marker);
  mesh.quaternion.set(orientation.x, orientation.y, orientation.z, orientation.w).normalize();
}

/**
 * Whether two boxes or cylinders differ at most in their pose: then the mesh is only moved.
 *
 * @param {Marker} one
 * @param {Marker} two
 */
function isSameSolid(one, two) {
  if (hasPicture(one) || hasPicture(two)) return false;
  /** @param {Marker} marker */
  const looks = ({ type, scale, color }) => [type, ...Object.values(scale), ...Object.values(color)].join(" ");
  return (one.type === MARKER.CUBE || one.type === MARKER.CYLINDER) && looks(one) === looks(two);
}

/**
 * Whether two strips are equal: the whole trail is published again whenever the pen has drawn. Only the number of
 * points and both ends are compared, because finished strokes do not change.
 *
 * @param {Marker} one
 * @param {Marker} two
 */
function isSameStrip(one, two) {
  if (one.type !== MARKER.LINE_STRIP || two.type !== MARKER.LINE_STRIP || one.points.length !== two.points.length) {
    return false;
  }
  /** @param {Marker} marker */
  const looks = ({ scale, color, points }) =>
    [points[0], points.at(-1), scale, color].flatMap((part) => Object.values(part ?? {})).join(" ");
  return looks(one) === looks(two);
}

/** @param {Marker} marker */
function triangles({ points, colors, scale }) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute(
    "position",
    new THREE.Float32BufferAttribute(
      points.flatMap(({ x, y, z }) => [x * scale.x, y * scale.y, z * scale.z]),
      3,
    ),
  );
  if (colors.length > 0) {
    const color = new THREE.Color();
    const values = colors.flatMap((declared) => groundColor(declared, color).toArray());
    geometry.setAttribute("color", new THREE.Float32BufferAttribute(values, 3));
  }
  geometry.computeVertexNormals();
  return geometry;
}

/**
 * A flat strip of the marker's width (scale.x) with round joints: WebGL's own lines are one pixel wide.
 *
 * @param {Marker} marker
 */
function ribbon({ points, scale }) {
  const half = scale.x / 2;
  /** @type {number[]} */ const corners = [];
  for (let index = 1; index < points.length; index++) {
    const [a, b] = [points[index - 1], points[index]];
    const length = Math.hypot(b.x - a.x, b.y - a.y) || 1;
    const [nx, ny] = [(-(b.y - a.y) / length) * half, ((b.x - a.x) / length) * half];
    corners.push(a.x - nx, a.y - ny, a.z, b.x - nx, b.y - ny, b.z, b.x + nx, b.y + ny, b.z);
    corners.push(a.x - nx, a.y - ny, a.z, b.x + nx, b.y + ny, b.z, a.x + nx, a.y + ny, a.z);
  }
  const sides = 10;
  for (const { x, y, z } of points) {
    for (let side = 0; side < sides; side++) {
      const [from, to] = [side, side + 1].map((step) => (2 * Math.PI * step) / sides);
      corners.push(
        x,
        y,
        z,
        x + half * Math.cos(from),
        y + half * Math.sin(from),
        z,
        x + half * Math.cos(to),
        y + half * Math.sin(to),
        z,
      );
    }
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(corners, 3));
  geometry.computeVertexNormals();
  return geometry;
}
