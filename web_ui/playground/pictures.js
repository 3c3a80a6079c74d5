// Images on the ground, decoded from their data URIs, each once.

/** @typedef {import("./markers.js").Picture} Picture */

/** Maximum side of a drawn image in pixels. */
const MOST_TEXELS = 2048;

export class Pictures {
  /** @param {() => void} changed  called when an image has been decoded */
  constructor(changed) {
    this.changed = changed;
    /** @type {Map<string, Picture | null>} */ this.known = new Map();
    /** @type {Map<string, Promise<void>>} */ this.reading = new Map();
  }

  /** The image; null while it is decoded, and if it is invalid. @param {string} uri @returns {Picture | null} */
  get(uri) {
    if (!this.known.has(uri)) void this.read(uri);
    return this.known.get(uri) ?? null;
  }

  /** @param {string} uri */
  read(uri) {
    let reading = this.reading.get(uri);
    if (reading === undefined) {
      this.known.set(uri, null);
      reading = decode(uri).then((picture) => {
        this.known.set(uri, picture);
        if (picture !== null) this.changed();
      });
      this.reading.set(uri, reading);
    }
    return reading;
  }
}

/** @param {string} uri @returns {Promise<Picture | null>} */
async function decode(uri) {
  const image = new Image();
  image.src = uri;
  try {
    await image.decode();
  } catch {
    return null;
  }
  const [width, height] = [image.naturalWidth || 1024, image.naturalHeight || 1024];
  const scale = Math.min(1, MOST_TEXELS / Math.max(width, height));
  const canvas = document.createElement("canvas");
  canvas.width = Math.max(1, Math.round(width * scale));
  canvas.height = Math.max(1, Math.round(height * scale));
  canvas.getContext("2d")?.drawImage(image, 0, 0, canvas.width, canvas.height);
  return { image: canvas, width, height };
}
