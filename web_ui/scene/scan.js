// The lidar of a robot: its head, and a dot where each beam of the last scan ended.

import * as THREE from "three";

import { Instances, placeOf } from "./instances.js";
import { litMaterial } from "./materials.js";
import { LIDAR_PLACE, HEIGHT_M } from "./parts.js";
import { SENSED } from "./rays.js";

/** @typedef {import("./robot_instances.js").Look} Look */
/** @typedef {import("../state/robot.js").Scan} Scan */

export const HEAD = { radius: 0.02, height: 0.016, color: 0x353029 };
const DOT_PX = 4;

/** @param {import("./robot_instances.js").Capacity} room */
export function createScan({ robots, fine }) {
  const shape = new THREE.CylinderGeometry(HEAD.radius, HEAD.radius, HEAD.height, fine ? 20 : 8).rotateX(Math.PI / 2);
  const head = new Instances(shape, litMaterial({ color: new THREE.Color(HEAD.color) }), { each: 1, robots });
  const place = placeOf({ ...LIDAR_PLACE, z: HEIGHT_M + HEAD.height / 2 });
  const dots = new Dots();
  return {
    parts: [head, dots],
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, { robot, sensing }, before) {
      head.put(slot, 0, robot.hasLidar ? place : null);
      if (before !== null && before.robot.scan === robot.scan && before.sensing === sensing) return;
      dots.put(slot, robot.scan === null || !sensing ? [] : scanEnds(robot.scan));
    },
  };
}

/** Where the beams of a scan ended, in the robot's frame: x, y, x, y, …; none for a beam that met nothing. @param {Scan} scan */
export function scanEnds({ ranges, angleMin, step }) {
  /** @type {number[]} */ const ends = [];
  for (let beam = 0; beam < ranges.length; beam++) {
    if (!Number.isFinite(ranges[beam])) continue;
    const angle = angleMin + beam * step;
    ends.push(LIDAR_PLACE.x + ranges[beam] * Math.cos(angle), LIDAR_PLACE.y + ranges[beam] * Math.sin(angle));
  }
  return ends;
}

/** The dots of all robots in one draw call. As `Instances`, of which the number of copies is fixed. */
class Dots {
  constructor() {
    const material = new THREE.PointsMaterial({ color: SENSED, size: DOT_PX, sizeAttenuation: false });
    this.mesh = new THREE.Points(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    /** @type {number[][]} in the frames of the robots */ this.ends = [];
    /** @type {number[][]} in the world: x, y, z */ this.places = [];
    this.robots = 0;
    this.changed = true;
  }

  /** @param {number} robot @param {number[]} ends  effective at the next `place` */
  put(robot, ends) {
    this.ends[robot] = ends;
  }

  /** @param {number} robot @param {THREE.Matrix4} frame  of the robot in the world */
  place(robot, frame) {
    const ends = this.ends[robot];
    /** @type {number[]} */ const places = [];
    const place = new THREE.Vector3();
    for (let at = 0; at < ends.length; at += 2) {
      place.set(ends[at], ends[at + 1], LIDAR_PLACE.z).applyMatrix4(frame);
      places.push(place.x, place.y, place.z);
    }
    this.places[robot] = places;
    this.changed = true;
  }

  /** Draw the dots of the first robots. @param {number} robots */
  show(robots) {
    if (!this.changed && robots === this.robots) return;
    this.changed = false;
    this.robots = robots;
    const all = this.places.slice(0, robots).flat();
    const { geometry } = this.mesh;
    const known = /** @type {THREE.BufferAttribute | undefined} */ (geometry.getAttribute("position"));
    if (known === undefined || known.array.length < all.length) {
      geometry.dispose(); // a buffer cannot grow
      geometry.setAttribute("position", new THREE.Float32BufferAttribute(all, 3).setUsage(THREE.DynamicDrawUsage));
    } else {
      known.array.set(all);
      known.needsUpdate = true;
    }
    geometry.setDrawRange(0, all.length / 3);
    this.mesh.visible = all.length > 0;
  }

  dispose() {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}
