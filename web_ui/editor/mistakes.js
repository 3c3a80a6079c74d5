// What a mistake in the text means: a title, a sentence, how it would be right, and the word on the button. Pure.

/** @typedef {import("./marks.js").Repair} Repair */
/** @typedef {import("./marks.js").Mark} Mark */
/** @typedef {import("../i18n/index.js").Translate} Translate */
/** @typedef {{ before: string, old: string, now: string, after: string }} Change   a line, before and after a repair */
/**
 * @typedef {object} Mistake
 * @property {string} title
 * @property {string} text       a sentence; may be empty
 * @property {string} more       what the compiler says; empty: nothing that is not said already
 * @property {Change | null} change
 * @property {string} button     empty: it cannot be corrected by itself
 */

const LONGEST_WORD = 14; // letters on a button
const LONGEST_CONTEXT = 28; // letters before and after a change

/**
 * The button label of a repair.
 *
 * @param {Translate} t
 * @param {string} text
 * @param {Repair} repair
 */
export function repairLabel(t, text, { from, to, insert }) {
  const old = text.slice(from, to).trim();
  const now = insert.trim();
  /** @param {string} word */
  const isShort = (word) => word.length <= LONGEST_WORD && !word.includes("\n");
  if (!isShort(old) || !isShort(now) || /\s/.test(old) || (old === "" && now === "")) return t("hint.correct");
  if (now === "") return t("hint.remove", { old });
  return old === "" ? t("hint.insert", { now }) : t("hint.change", { now });
}

/**
 * The line that a repair changes; null if it changes several lines.
 *
 * @param {string} text
 * @param {Repair} repair
 * @returns {Change | null}
 */
export function changeOf(text, { from, to, insert }) {
  const old = text.slice(from, to);
  if (old.trim().includes("\n") || insert.trim().includes("\n")) return null;
  const [, lead, now, trail] = /** @type {RegExpExecArray} */ (/^(\s*)([^]*?)(\s*)$/.exec(insert));
  const isOwnLine = lead.includes("\n") || trail.includes("\n");
  if (isOwnLine && old.trim() === "") return { before: "", old: "", now, after: "" };
  const start = text.lastIndexOf("\n", from - 1) + 1;
  const end = text.indexOf("\n", to);
  const isNew = old.trim() === "";
  const before = text.slice(start, from).trimStart() + (isNew ? lead : (/^\s*/.exec(old)?.[0] ?? ""));
  const rest = text.slice(to, end < 0 ? undefined : end).trimEnd();
  const after = (isNew ? trail : (/\s*$/.exec(old)?.[0] ?? "")) + rest;
  return {
    before: before.length > LONGEST_CONTEXT ? `…${before.slice(-LONGEST_CONTEXT)}` : before,
    old: old.trim(),
    now,
    after: after.length > LONGEST_CONTEXT ? `${after.slice(0, LONGEST_CONTEXT)}…` : after,
  };
}

/** As a sentence: the compiler's messages begin with a small letter. @param {string} text */
export function sentence(text) {
  const words = text.trim();
  if (words === "") return "";
  return words[0].toUpperCase() + words.slice(1) + (/[.!?…]$|: \S.*$/.test(words) ? "" : ".");
}

/**
 * The first text that there is; empty: none.
 *
 * @param {Translate} t
 * @param {readonly string[]} keys
 */
function firstText(t, keys) {
  for (const key of keys) if (t(key) !== key) return t(key);
  return "";
}

/**
 * @param {Translate} t
 * @param {string} text   the checked text
 * @param {Pick<Mark, "message" | "kind" | "hint" | "hintKind" | "repair">} mark
 * @returns {Mistake}
 */
export function explainMistake(t, text, { message, kind = "", hint = "", hintKind = "", repair = null }) {
  const names = [hintKind, kind].map((name) => name.replace(/^hint-|-hint$/g, "").replaceAll("-", "_")).filter((name) => name !== "");
  const title = firstText(t, [...names.map((name) => `mistake.${name}`), "mistake.other"]);
  const own = firstText(t, names.map((name) => `mistake.${name}.text`)); // prettier-ignore
  const said = own || sentence(hint || message);
  return {
    title,
    text: said,
    more: [hint, message].map(sentence).filter((words) => words !== "" && words !== said).join(" "), // prettier-ignore
    change: repair === null ? null : changeOf(text, repair),
    button: repair === null ? "" : repairLabel(t, text, repair),
  };
}

/**
 * How many mistakes there are, in words.
 *
 * @param {Translate} t
 * @param {readonly { line: number | null }[]} errors
 */
export function countMistakes(t, errors) {
  const line = errors[0]?.line ?? 1;
  return errors.length === 1 ? t("mistakes.one", { line }) : t("mistakes.many", { count: errors.length, line });
}
