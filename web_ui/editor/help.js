// Completions and tooltips, from the robot's target description, the file and the text.

/** @typedef {import("./state.js").Target} Target */
/** @typedef {import("./state.js").Native} Native */
/** @typedef {import("./outline.js").Definition} Definition */
/** @typedef {"variable" | "constant" | "event" | "native" | "subroutine" | "keyword"} Kind */
/**
 * @typedef {{ name: string, kind: Kind, detail: string, help: string, native?: Native, rank: number }} Item
 * rank: order among completions that match equally: 0 names of the text, 1 keywords, 2 names of the robot
 */
/**
 * @typedef {object} Vocabulary
 * @property {Target | null} target
 * @property {readonly { name: string, value: number }[]} events      events of the file, with sizes
 * @property {readonly { name: string, value: number }[]} constants   constants of the file
 * @property {readonly { name: string, size?: number }[]} variables   variables of the text as reported by the compiler
 * @property {readonly Definition[]} definitions                      definitions of the text
 */

export const WORD = /[\p{L}\p{N}_][\p{L}\p{N}_.]*/u;
const UNFINISHED = /(?:\b(onevent|emit|_emit|callsub|call|sub|var|const)\s+)?([\p{L}\p{N}_][\p{L}\p{N}_.]*)?$/u;

/** What may follow each of these words; [] means a new name. */
const FOLLOWERS = /** @type {Record<string, Kind[]>} */ ({
  onevent: ["event"],
  emit: ["event"],
  _emit: ["event"],
  call: ["native"],
  callsub: ["subroutine"],
  sub: [],
  var: [],
  const: [],
});

/** @param {Native} native  shows the sizes of its parameters: name, name[3], name[] */
export function signature({ name, parameters }) {
  const listed = parameters.map((each) =>
    each.size === 1 ? each.name : `${each.name}[${each.size > 0 ? each.size : ""}]`,
  );
  return `${name}(${listed.join(", ")})`;
}

/**
 * All names, those of the text first.
 *
 * @param {Vocabulary} vocabulary
 * @returns {Item[]}
 */
export function items({ target, events, constants, variables, definitions }) {
  /** @type {Map<string, Item>} */ const found = new Map();
  let rank = 0;
  /** @param {Omit<Item, "rank">} item */
  const add = (item) => {
    const key = `${item.kind} ${item.name}`;
    if (!found.has(key)) found.set(key, { ...item, rank: item.kind === "keyword" ? 1 : rank });
  };
  /** @param {number | undefined} size */
  const dimension = (size) => (size === undefined || size === 1 ? "" : `[${size}]`);
  for (const { name, size } of variables) add({ name, kind: "variable", detail: dimension(size), help: "" });
  for (const { name, kind } of definitions) if (kind !== "event") add({ name, kind, detail: "", help: "" });
  for (const { name, value } of constants) add({ name, kind: "constant", detail: `= ${value}`, help: "" });
  for (const { name, value } of events) add({ name, kind: "event", detail: dimension(value), help: "" });
  rank = 2;
  for (const { name, size, hidden, help } of target?.variables ?? []) {
    if (!hidden) add({ name, kind: "variable", detail: dimension(size), help });
  }
  for (const { name, help } of target?.events ?? []) add({ name, kind: "event", detail: "", help });
  for (const native of target?.natives ?? []) {
    if (!native.hidden)
      add({
        name: native.name,
        kind: "native",
        detail: signature(native).slice(native.name.length),
        help: native.help,
        native,
      });
  }
  for (const name of target?.keywords ?? []) add({ name, kind: "keyword", detail: "", help: "" });
  return [...found.values()];
}

/**
 * Completions for the text of a line up to the cursor, and the start of the current word.
 *
 * @param {string} before
 * @param {Vocabulary} vocabulary
 * @returns {{ from: number, items: Item[] }}
 */
export function suggestions(before, vocabulary) {
  const comment = before.indexOf("#") >= 0;
  const [, keyword, word = ""] = UNFINISHED.exec(before) ?? [];
  const from = before.length - word.length;
  if (comment || /^\d/.test(word)) return { from, items: [] };
  const kinds =
    keyword === undefined ? /** @type {Kind[]} */ (["variable", "constant", "keyword"]) : FOLLOWERS[keyword];
  const own = new Set(vocabulary.events.map(({ name }) => name));
  const emits = keyword === "emit" || keyword === "_emit";
  const fitting = items(vocabulary).filter(({ kind, name }) => kinds.includes(kind) && (!emits || own.has(name)));
  return { from, items: fitting };
}

/**
 * The description of the word at a column; null for an unknown word.
 *
 * @param {string} line
 * @param {number} column  counted from 0
 * @param {Vocabulary} vocabulary
 * @returns {{ from: number, to: number, item: Item } | null}
 */
export function explain(line, column, vocabulary) {
  for (const match of line.matchAll(new RegExp(WORD, "gu"))) {
    const [from, to] = [match.index, match.index + match[0].length];
    if (column < from || column > to) continue;
    const [, keyword] = UNFINISHED.exec(line.slice(0, from)) ?? [];
    const kinds = FOLLOWERS[keyword] ?? [];
    const named = items(vocabulary).filter(({ name }) => name === match[0]);
    const item = named.find(({ kind }) => kinds.includes(kind)) ?? named[0];
    return item === undefined ? null : { from, to, item };
  }
  return null;
}

/** What a name of a kind may also be, for `isTaken`. */
const TAKEN = /** @type {Readonly<Record<import("./names.js").Place["kind"], Kind[]>>} */ ({
  value: ["variable", "constant"],
  subroutine: ["subroutine"],
  event: ["event"],
  native: ["native"],
});

/**
 * Whether the robot, the file or the language already uses a name; names that the text defines do not count.
 *
 * @param {string} name
 * @param {import("./names.js").Place["kind"]} kind
 * @param {Omit<Vocabulary, "definitions">} vocabulary
 */
export function isTaken(name, kind, vocabulary) {
  const known = items({ ...vocabulary, variables: [], definitions: [] });
  return known.some((item) => item.name === name && (item.kind === "keyword" || TAKEN[kind].includes(item.kind)));
}
