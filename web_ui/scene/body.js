// The body of the robot: shell, details, lights and buttons in one mesh, and a dark line around it.

import * as THREE from "three";

import { addDetails, addFarDetails } from "./details.js";
import { addHull, Builder, HULLS } from "./hull.js";
import { Instances } from "./instances.js";
import { Lamps } from "./lamps.js";
import { outlineMaterial, robotMaterial } from "./materials.js";

/** @typedef {import("./robot_instances.js").Capacity} Capacity */
/** @typedef {import("./robot_instances.js").Look} Look */

const OUTLINE_M = 0.0007;
const HERE = new THREE.Matrix4();

/** @param {Capacity} room */
export function createBody({ robots }) {
  const line = new Builder();
  addHull(line, HULLS.outline);
  const outline = new Instances(line.geometry(), outlineMaterial(OUTLINE_M), { each: 1, robots });
  outline.mesh.renderOrder = 3;
  return bodyPiece({ robots, fineness: HULLS.near, addParts: addDetails, others: [outline] });
}

/** A robot that is small on the screen. @param {Capacity} room */
export function createFarBody({ robots }) {
  return bodyPiece({ robots, fineness: HULLS.far, addParts: addFarDetails, others: [] });
}

/** @param {{ robots: number, fineness: typeof HULLS.near, addParts: typeof addDetails, others: Instances[] }} how */
function bodyPiece({ robots, fineness, addParts, others }) {
  const builder = new Builder();
  addHull(builder, fineness);
  addParts(builder);
  const lamps = new Lamps(robots);
  const body = new Instances(builder.geometry(), robotMaterial(lamps.texture), { each: 1, robots });
  const parts = [body, ...others];
  return {
    parts,
    lamps,
    /** @param {number} slot @param {Look} look @param {Look | null} before */
    show(slot, look, before) {
      for (const part of parts) part.put(slot, 0, HERE);
      lamps.show(slot, look, before);
    },
    dispose: () => lamps.dispose(),
  };
}
