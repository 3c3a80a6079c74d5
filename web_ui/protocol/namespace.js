// The namespace of the suite: the page uses names without it, the connection uses full names.

/** Topics that have the same name in every namespace (docs/ros.md). */
const GLOBAL = new Set(["/clock", "/diagnostics", "/parameter_events", "/rosout", "/tf", "/tf_static"]);

/** Every simulator publishes this topic; its prefix is the namespace of the suite. */
const SIMULATOR = "/simulator/_state";

export class Namespace {
  constructor() {
    /** @type {string} */ this.prefix = "";
    /** @type {string} */ this.preferred = "";
  }

  /** The namespace of the bridge; the simulator of the page is in it or below it. @param {string} name */
  prefer(name) {
    this.preferred = name.replace(/\/+$/, "");
    this.prefix = this.preferred;
  }

  /**
   * Find the simulator among the topics; returns whether the namespace has changed.
   *
   * @param {Iterable<string>} topics  all advertised topics
   */
  choose(topics) {
    const found = [...topics]
      .filter((topic) => topic.endsWith(SIMULATOR) && topic.startsWith(`${this.preferred}/`))
      .map((topic) => topic.slice(0, -SIMULATOR.length));
    if (found.length === 0) return false;
    const chosen = [this.preferred, this.prefix].find((prefix) => found.includes(prefix)) ?? found.sort()[0];
    const isOther = chosen !== this.prefix;
    this.prefix = chosen;
    return isOther;
  }

  /**
   * The page's name of a topic, service or parameter; null if it belongs to another suite.
   *
   * @param {string} name
   */
  inner(name) {
    if (this.prefix === "" || GLOBAL.has(name)) return name;
    return name.startsWith(`${this.prefix}/`) ? name.slice(this.prefix.length) : null;
  }

  /** The full name for a name of the page. @param {string} name */
  outer(name) {
    return GLOBAL.has(name) ? name : this.prefix + name;
  }
}
