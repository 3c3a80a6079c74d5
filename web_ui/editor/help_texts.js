// Help texts in the page's language: requested once, and merged into the target descriptions of robots.

/** @typedef {import("./state.js").Target} Target */
/** @typedef {import("../input/runtime_client.js").RuntimeClient} RuntimeClient */

const KINDS = /** @type {const} */ (["variables", "events", "natives"]);

export class HelpTexts {
  /** @param {string} language */
  constructor(language) {
    this.language = language;
    this.isRequested = false;
    /** @type {Map<string, string>} */ this.words = new Map();
    /** @type {WeakMap<Target, Target>} */ this.known = new WeakMap();
  }

  /**
   * Request the help texts unless that was done.
   *
   * @param {RuntimeClient} runtime
   * @param {() => void} changed  called when help texts have arrived
   */
  async load(runtime, changed) {
    if (this.isRequested) return;
    this.isRequested = true;
    const target = await runtime.target(this.language);
    if (target === null) return;
    for (const kind of KINDS) for (const { name, help } of target[kind]) this.words.set(`${kind} ${name}`, help);
    this.known = new WeakMap();
    changed();
  }

  /**
   * The target with translated help; the same object for the same target.
   *
   * @template {Target | null} T
   * @param {T} target
   * @returns {T}
   */
  translate(target) {
    if (target === null) return target;
    const found = this.known.get(target);
    if (found !== undefined) return /** @type {T} */ (found);
    const translated = { ...target };
    for (const kind of KINDS) {
      /** @type {any} */ (translated)[kind] = target[kind].map((entry) => ({
        ...entry,
        help: this.words.get(`${kind} ${entry.name}`) ?? entry.help,
      }));
    }
    this.known.set(target, translated);
    return translated;
  }
}
