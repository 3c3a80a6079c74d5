// What is around a playground: the desk it lies on, or the floor of a room for a large one, the wall behind, and a few
// things that lie there. None of it is part of the playground: the robot's sensors do not notice it.

import * as THREE from "three";

import { DESK } from "./colors.js";
import { LIGHT } from "./lights.js";
import { litMaterial, overlayMaterial } from "./materials.js";
import { merged } from "./merged.js";
import { STILL_LAYER } from "./still_ground.js";
import { WOOD_M, woodTexture } from "./wood.js";

/** @typedef {{ min: { x: number, y: number }, max: { x: number, y: number } }} Bounds */
/** @typedef {{ bounds: Bounds, edges: [number, number][][], isWalled: boolean }} Ground  edges: borders of its floors */

/** A ground that is longer lies on the floor of a room. */
const LONGEST_ON_DESK_M = 1.5;
const SHEET_M = 0.012;
const GRID = { columns: 28, rows: 20 };
const WALL = { top: new THREE.Color(0xefe4d3), bottom: new THREE.Color(0xd9c7ab) };

/** Light that falls through a window: two soft stripes. @param {number} x @param {number} y  in sizes of the ground */
function windowLight(x, y) {
  const along = x * 0.82 - y * 0.57 + 0.62;
  const across = x * 0.57 + y * 0.82;
  /** @param {number} at @param {number} half */
  const stripe = (at, half) => Math.max(0, 1 - Math.abs(along - at) / half) ** 0.8;
  return Math.max(stripe(0, 0.42), stripe(0.95, 0.4)) * Math.max(0, 1 - Math.abs(across) / 2.1);
}

export class Surroundings {
  /** @param {() => void} changed  called when the wood has been painted */
  constructor(changed) {
    this.changed = changed;
    this.group = new THREE.Group();
    this.backdrop = backdrop();
    this.backdrop.layers.set(STILL_LAYER);
    /** @type {THREE.Texture | null} */ this.wood = null;
    /** @type {Ground | null} */ this.ground = null;
    this.isPainting = false;
  }

  /** @param {Ground | null} ground  null: none, as for an empty world */
  update(ground) {
    this.ground = ground;
    this.#clear();
    this.group.add(this.backdrop);
    if (ground === null) return;
    const { min, max } = ground.bounds;
    const [long, wide] = [max.x - min.x, max.y - min.y];
    const isDesk = Math.max(long, wide) <= LONGEST_ON_DESK_M;
    const floor = ground.isWalled ? -0.001 : -SHEET_M;
    this.group.add(desk(ground.bounds, isDesk, floor, this.wood));
    if (!ground.isWalled) this.group.add(...sheet(ground.edges));
    if (isDesk && ground.isWalled) this.group.add(...things(ground.bounds, floor));
    for (const mesh of this.group.children) mesh.layers.set(STILL_LAYER);
    if (this.wood === null && !this.isPainting && typeof document !== "undefined") {
      this.isPainting = true;
      whenIdle(() => {
        this.wood = woodTexture();
        this.update(this.ground);
        this.changed();
      });
    }
  }

  #clear() {
    for (const child of [...this.group.children]) {
      if (child === this.backdrop) continue;
      const mesh = /** @type {THREE.Mesh<THREE.BufferGeometry, THREE.Material>} */ (child);
      mesh.geometry.dispose();
      mesh.material.dispose();
      this.group.remove(child);
    }
  }

  dispose() {
    this.#clear();
    this.wood?.dispose();
    this.backdrop.geometry.dispose();
    this.backdrop.material.dispose();
  }
}

/** After the first picture of the playground, so that it does not wait. @param {() => void} work */
function whenIdle(work) {
  if ("requestIdleCallback" in window) window.requestIdleCallback(work, { timeout: 1500 });
  else setTimeout(work, 300);
}

/** The wall behind everything, in the whole picture; drawn last, where nothing else is. */
function backdrop() {
  const geometry = new THREE.BufferGeometry()
    .setAttribute("position", new THREE.Float32BufferAttribute([-1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1], 3))
    .setIndex([0, 1, 2, 0, 2, 3]);
  const material = new THREE.ShaderMaterial({
    uniforms: { ...LIGHT, uTop: { value: WALL.top }, uBottom: { value: WALL.bottom } },
    vertexShader: /* glsl */ `
      uniform vec3 uTop, uBottom, uDim;
      varying vec3 vColor;
      void main() {
        vColor = mix(uBottom, uTop, position.y * 0.5 + 0.5) * uDim;
        gl_Position = vec4(position.xy, 1.0, 1.0);
      }
    `,
    fragmentShader: /* glsl */ `
      varying vec3 vColor;
      void main() { gl_FragColor = vec4(vColor, 1.0); }
    `,
    depthFunc: THREE.LessEqualDepth,
    depthWrite: false,
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = 20_000; // last of the opaque ones
  mesh.raycast = () => {};
  return mesh;
}

/**
 * A desk, or the floor of a room: brighter where light falls through a window, darker far away.
 *
 * @param {Bounds} bounds
 * @param {boolean} isDesk
 * @param {number} height
 * @param {THREE.Texture | null} wood
 */
function desk({ min, max }, isDesk, height, wood) {
  const [middleX, middleY] = [(min.x + max.x) / 2, (min.y + max.y) / 2];
  const size = Math.max(max.x - min.x, max.y - min.y, 0.6);
  const left = middleX - 2.6 * size;
  const right = middleX + 2.6 * size;
  const front = middleY - 2.4 * size;
  const back = max.y + 0.42 * size;
  const tile = WOOD_M * (isDesk ? 1 : 2.2);
  const base = isDesk ? 1 : 0.93;
  /** @type {number[]} */ const positions = [];
  /** @type {number[]} */ const colors = [];
  /** @type {number[]} */ const uvs = [];
  /** @type {number[]} */ const indices = [];
  for (let row = 0; row <= GRID.rows; row++) {
    for (let column = 0; column <= GRID.columns; column++) {
      const x = left + ((right - left) * column) / GRID.columns;
      const y = front + ((back - front) * row) / GRID.rows;
      const [shareX, shareY] = [(x - middleX) / size, (y - middleY) / size];
      const far = Math.hypot(shareX, shareY) ** 2;
      const light = base * (0.97 - 0.035 * far) + 0.15 * windowLight(shareX, shareY);
      positions.push(x, y, height);
      colors.push(light, light * (0.985 + 0.01 * windowLight(shareX, shareY)), light * 0.97);
      uvs.push(x / tile, y / tile);
      if (row === GRID.rows || column === GRID.columns) continue;
      const at = row * (GRID.columns + 1) + column;
      indices.push(at, at + 1, at + GRID.columns + 2, at, at + GRID.columns + 2, at + GRID.columns + 1);
    }
  }
  const geometry = new THREE.BufferGeometry()
    .setAttribute("position", new THREE.Float32BufferAttribute(positions, 3))
    .setAttribute("normal", new THREE.Float32BufferAttribute(positions.map((_, at) => (at % 3 === 2 ? 1 : 0)), 3))
    .setAttribute("color", new THREE.Float32BufferAttribute(colors, 3))
    .setAttribute("uv", new THREE.Float32BufferAttribute(uvs, 2))
    .setIndex(indices);
  const material = litMaterial({
    flat: true,
    vertexColors: true,
    map: wood,
    color: wood === null ? DESK.clone() : new THREE.Color(0xffffff),
  });
  const mesh = new THREE.Mesh(geometry, material);
  mesh.renderOrder = 10_000; // after everything that covers it
  mesh.raycast = () => {};
  return mesh;
}

/** A playground without walls lies on a board: its side, and the shade under it. @param {[number, number][][]} edges */
function sheet(edges) {
  /** @type {number[]} */ const side = [];
  /** @type {number[]} */ const shade = [];
  /** @type {number[]} */ const opacities = [];
  for (const [[fromX, fromY], [toX, toY]] of edges) {
    side.push(fromX, fromY, 0, fromX, fromY, -SHEET_M, toX, toY, -SHEET_M);
    side.push(fromX, fromY, 0, toX, toY, -SHEET_M, toX, toY, 0);
    const long = Math.hypot(toX - fromX, toY - fromY) || 1;
    const [outX, outY] = [((toY - fromY) / long) * 0.02 + 0.005, ((fromX - toX) / long) * 0.02 + 0.003];
    const z = -SHEET_M + 0.0008;
    shade.push(fromX, fromY, z, fromX + outX, fromY + outY, z, toX + outX, toY + outY, z);
    shade.push(fromX, fromY, z, toX + outX, toY + outY, z, toX, toY, z);
    opacities.push(...[0.5, 0, 0, 0.5, 0, 0.5].flatMap((value) => [value, value, value]));
  }
  const board = new THREE.BufferGeometry().setAttribute("position", new THREE.Float32BufferAttribute(side, 3));
  board.computeVertexNormals();
  const under = new THREE.BufferGeometry()
    .setAttribute("position", new THREE.Float32BufferAttribute(shade, 3))
    .setAttribute("color", new THREE.Float32BufferAttribute(opacities, 3));
  const meshes = [
    new THREE.Mesh(board, litMaterial({ color: new THREE.Color(0xcbb999), side: THREE.DoubleSide })),
    new THREE.Mesh(under, overlayMaterial({ vertexColors: true, color: new THREE.Color(0x3a2614) })),
  ];
  for (const mesh of meshes) mesh.raycast = () => {};
  return meshes;
}

/** A pencil and a roll of tape beside the playground. @param {Bounds} bounds @param {number} floor */
function things({ min, max }, floor) {
  const pencil = merged([
    [new THREE.CylinderGeometry(0.0036, 0.0036, 0.13, 6), 0xe0912f],
    [new THREE.CylinderGeometry(0.0036, 0.0036, 0.012, 6).translate(0, -0.071, 0), 0xd9827a],
    [new THREE.CylinderGeometry(0.0038, 0.0038, 0.006, 8).translate(0, -0.063, 0), 0xb9b5ad],
    [new THREE.CylinderGeometry(0.0012, 0.0036, 0.014, 6).translate(0, 0.072, 0), 0xe9cfa4],
    [new THREE.CylinderGeometry(0.0001, 0.0012, 0.005, 6).translate(0, 0.0815, 0), 0x38332d],
  ]);
  pencil.rotateZ(-2.2).translate(min.x - 0.15, min.y + (max.y - min.y) * 0.62, floor + 0.0038);
  const profile = [
    [0.02, 0],
    [0.038, 0],
    [0.038, 0.02],
    [0.02, 0.02],
    [0.02, 0],
  ].map(([x, y]) => new THREE.Vector2(x, y));
  const roll = merged([
    [new THREE.LatheGeometry(profile, 24).rotateX(Math.PI / 2), 0x37322d],
    [new THREE.LatheGeometry([new THREE.Vector2(0.0199, 0.0202), new THREE.Vector2(0.0199, 0)], 20).rotateX(Math.PI / 2), 0xb59a74],
  ]);
  roll.translate(max.x + 0.14, min.y + (max.y - min.y) * 0.42, floor);
  return [pencil, roll].map((shape) => {
    const mesh = new THREE.Mesh(shape, litMaterial({ vertexColors: true, side: THREE.DoubleSide }));
    mesh.raycast = () => {};
    return mesh;
  });
}
