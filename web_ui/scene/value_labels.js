// Labels with Thymio's integers at the beams and ground patches of the selected robot.

import { GROUND, PROXIMITY } from "../state/names.js";
import { GROUND_PLACES, PROXIMITY_PLACES } from "./parts.js";
import { MAX_RANGE_M } from "./rays.js";

/** @typedef {import("../state/robot.js").Robot} Robot */
/** @typedef {{ x: number, y: number, z: number }} Place  in the robot's frame */

const BESIDE_M = 0.03;

/**
 * Every value with its position in the robot's frame.
 *
 * @param {Robot} robot
 * @returns {{ text: string, place: Place }[]}
 */
export function valueLabelsOf({ raw, proximity }) {
  const beams = PROXIMITY.map((name, index) => {
    const { x, y, z, yaw } = PROXIMITY_PLACES[name];
    const range = proximity[name];
    const length = Number.isFinite(range) ? Math.max(range, 0.02) : MAX_RANGE_M;
    return { value: raw.proximity?.[index], place: { x: x + length * Math.cos(yaw), y: y + length * Math.sin(yaw), z } };
  });
  const ground = GROUND.map((name, index) => {
    const { x, y } = GROUND_PLACES[name];
    return { value: raw.ground?.[4 + index], place: { x, y: y + Math.sign(y) * BESIDE_M, z: 0 } };
  });
  return [...beams, ...ground].flatMap(({ value, place }) =>
    value === undefined ? [] : [{ text: String(value), place }],
  );
}

export class ValueLabels {
  /** @param {HTMLElement} layer */
  constructor(layer) {
    this.layer = layer;
    /** @type {HTMLElement[]} */ this.spans = [];
  }

  /**
   * @param {{ text: string, place: Place }[]} numbers
   * @param {(place: Place) => { x: number, y: number } | null} project  to CSS pixels
   */
  show(numbers, project) {
    while (this.spans.length < numbers.length) {
      const span = document.createElement("span");
      span.className = "ray-number";
      this.spans.push(span);
      this.layer.append(span);
    }
    this.spans.forEach((span, index) => {
      const number = numbers[index];
      const at = number === undefined ? null : project(number.place);
      span.hidden = at === null;
      if (at === null) return;
      if (span.textContent !== number.text) span.textContent = number.text;
      span.style.transform = `translate(${at.x}px, ${at.y}px) translate(-50%, -50%)`;
    });
  }
}
