// Thumbnails of the shipped playgrounds: loaded from the server on demand and drawn from the playground data.

import { parse } from "../playground/document.js";
import { Markers } from "../playground/markers.js";
import { Pictures } from "../playground/pictures.js";
import { worldOf } from "../playground/world.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {{ playground: Playground, picture: string }} Sample  picture: URL of the image */

const SMALL = { width: 240, height: 160 };

export class ThumbnailCache {
  /** @param {(world: import("../state/index.js").State) => Promise<HTMLCanvasElement>} photograph */
  constructor(photograph) {
    this.photograph = photograph;
    this.pictures = new Pictures(() => {});
    this.markers = new Markers((uri) => this.pictures.get(uri));
    /** @type {Map<string, Promise<Sample | null>>} */ this.samples = new Map();
  }

  /** A shipped playground with its thumbnail; null if it is not available. @param {string} name */
  sample(name) {
    let sample = this.samples.get(name);
    if (sample === undefined) {
      sample = this.#make(name).catch(() => null);
      this.samples.set(name, sample);
      sample.then((found) => found === null && this.samples.delete(name)); // retried next time
    }
    return sample;
  }

  /** @param {string} name @returns {Promise<Sample>} */
  async #make(name) {
    const answer = await fetch(`playgrounds/${encodeURIComponent(name)}.json`);
    if (!answer.ok) throw new Error(answer.statusText);
    const playground = parse(await answer.text());
    const images = playground.items.filter(({ kind }) => kind === "picture").map(({ image }) => image);
    await Promise.all(images.map((uri) => this.pictures.read(uri)));
    const drawn = await this.photograph(worldOf(playground.items, this.markers));
    return { playground, picture: smaller(drawn).toDataURL("image/png") };
  }
}

/** @param {HTMLCanvasElement} picture */
function smaller(picture) {
  const canvas = Object.assign(document.createElement("canvas"), SMALL);
  const context = canvas.getContext("2d");
  if (context !== null) context.imageSmoothingQuality = "high";
  context?.drawImage(picture, 0, 0, SMALL.width, SMALL.height);
  return canvas;
}
