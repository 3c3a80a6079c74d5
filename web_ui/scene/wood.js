// Planks of a desk or a floor, painted once on a canvas.

import * as THREE from "three";

/** Side of the tile that repeats. */
export const WOOD_M = 0.9;
const TILE = { pixels: 512, planks: 6 };
const TINTS = ["#d3a977", "#d9b17f", "#dcb688", "#d6ad7b", "#e1bd90", "#d8b084"];

/** A tile of planks. */
export function woodTexture() {
  const { pixels, planks } = TILE;
  const canvas = Object.assign(document.createElement("canvas"), { width: pixels, height: pixels });
  const context = canvas.getContext("2d");
  const random = randomNumbers(7);
  if (context !== null) for (let plank = 0; plank < planks; plank++) paintPlank(context, plank, random);
  const texture = new THREE.CanvasTexture(canvas);
  texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
  texture.minFilter = THREE.LinearMipmapNearestFilter;
  texture.anisotropy = 1;
  return texture;
}

/** @param {CanvasRenderingContext2D} context @param {number} plank @param {() => number} random */
function paintPlank(context, plank, random) {
  const { pixels, planks } = TILE;
  const [top, high] = [(plank * pixels) / planks, pixels / planks];
  const joint = random() * pixels;
  context.save();
  context.beginPath();
  context.rect(0, top, pixels, high);
  context.clip();
  context.fillStyle = TINTS[plank % TINTS.length];
  context.fillRect(0, top, pixels, high);
  context.fillStyle = TINTS[(plank + 2) % TINTS.length];
  context.fillRect(joint, top, pixels * 0.45, high);
  context.fillRect(joint - pixels, top, pixels * 0.45, high);
  for (let grain = 0; grain < 26; grain++) {
    const y = top + random() * high;
    const long = pixels * (0.25 + 0.75 * random());
    const from = random() * pixels;
    const bend = (random() - 0.5) * 9;
    context.strokeStyle = `rgb(143 98 52 / ${7 + 10 * random()}%)`;
    context.lineWidth = 0.6 + 1.6 * random();
    for (const shift of [0, -pixels]) {
      context.beginPath();
      context.moveTo(from + shift, y);
      context.bezierCurveTo(from + shift + long / 3, y + bend, from + shift + (2 * long) / 3, y - bend, from + shift + long, y);
      context.stroke();
    }
  }
  context.fillStyle = "rgb(92 58 24 / 38%)";
  context.fillRect(0, top + high - 1, pixels, 1);
  for (const at of [joint, joint - pixels, joint + 0.45 * pixels, joint - 0.55 * pixels]) context.fillRect(at, top, 1, high);
  context.fillStyle = "rgb(255 240 214 / 30%)";
  context.fillRect(0, top, pixels, 1);
  context.restore();
}

/** The same numbers on every machine. @param {number} seed */
function randomNumbers(seed) {
  let state = seed;
  return () => {
    state = (state * 1_664_525 + 1_013_904_223) % 4_294_967_296;
    return state / 4_294_967_296;
  };
}
