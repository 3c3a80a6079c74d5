// The file that was opened last, and where it was dropped: if it is rejected, the reason is shown there.

/** @typedef {{ x: number, y: number }} Place   CSS pixels of the window */
/** @typedef {{ file: File, place: Place | null }} Opening   place: null if it was chosen in a dialog */

/** Larger files are not read again to find out what is wrong. */
const MOST_BYTES = 3_000_000;

export class OpenedFile {
  constructor() {
    /** @type {Opening | null} */ this.last = null;
  }

  /** @param {File} file @param {Place | null} [place] */
  note(file, place = null) {
    this.last = { file, place };
  }

  /** Call when the file was accepted or rejected. */
  forget() {
    this.last = null;
  }

  /** How the file of that name was opened; null: it was not the last one. @param {string} name */
  of(name) {
    return this.last?.file.name === name ? this.last : null;
  }

  /** The text of the file of that name; null if it is not at hand, or no text. @param {string} name */
  async textOf(name) {
    const file = this.of(name)?.file;
    if (file === undefined || file.size > MOST_BYTES) return null;
    try {
      return new TextDecoder("utf-8", { fatal: true }).decode(await file.arrayBuffer());
    } catch {
      return null;
    }
  }
}
