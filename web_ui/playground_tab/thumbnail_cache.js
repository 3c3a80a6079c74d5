// Thumbnails of playgrounds, drawn from their data: those that are shipped are loaded from the server on demand.

import { parse } from "../playground/document.js";
import { Markers } from "../playground/markers.js";
import { partsOf } from "../playground/parts.js";
import { Pictures } from "../playground/pictures.js";
import { worldOf } from "../playground/world.js";

/** @typedef {import("../playground/document.js").Playground} Playground */
/** @typedef {{ playground: Playground, picture: string }} Sample  picture: URL of the image */

const SMALL = { width: 240, height: 160 };

export class ThumbnailCache {
  /**
   * @param {(world: import("../state/index.js").State) => Promise<HTMLCanvasElement>} photograph
   * @param {(items: Playground["items"]) => Promise<unknown>} learn   asks the simulator for exact parts
   */
  constructor(photograph, learn) {
    this.photograph = photograph;
    this.learn = learn;
    this.pictures = new Pictures(() => {});
    this.markers = new Markers((uri) => this.pictures.get(uri));
    /** @type {Map<string, Promise<Sample | null>>} */ this.samples = new Map();
  }

  /** A shipped playground with its thumbnail; null if it is not available. @param {string} name */
  sample(name) {
    let sample = this.samples.get(name);
    if (sample === undefined) {
      sample = this.#load(name).catch(() => null);
      this.samples.set(name, sample);
      sample.then((found) => found === null && this.samples.delete(name)); // retried next time
    }
    return sample;
  }

  /** A playground with its thumbnail; null if it cannot be read or drawn. @param {string} text */
  async draw(text) {
    try {
      return await this.#make(parse(text));
    } catch {
      return null;
    }
  }

  /** @param {string} name */
  async #load(name) {
    const answer = await fetch(`playgrounds/${encodeURIComponent(name)}.json`);
    if (!answer.ok) throw new Error(answer.statusText);
    return this.#make(parse(await answer.text()));
  }

  /** @param {Playground} playground @returns {Promise<Sample>} */
  async #make(playground) {
    await this.learn(playground.items);
    const parts = playground.items.flatMap((item) => partsOf(item).primitives);
    await Promise.all(parts.map((part) => part.type === "print" && this.pictures.read(part.image)));
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
