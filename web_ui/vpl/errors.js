// The error of files that cannot be opened.

/** A file that cannot be opened: the key of a text in vpl.json, and its values. */
export class VplError extends Error {
  /** @param {string} key  of a text in vpl.json @param {Record<string, string | number>} [values] */
  constructor(key, values = {}) {
    super(`${key} ${JSON.stringify(values)}`);
    this.name = "VplError";
    this.key = key;
    this.values = values;
  }
}
