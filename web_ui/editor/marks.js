// The remarks of the check service as ranges of the text. Pure.

/** @typedef {import("../input/check_service.js").Remark} Remark */
/** @typedef {import("../input/check_service.js").Verdict} Verdict */
/** @typedef {{ from: number, to: number, insert: string }} Repair  an edit as a change of the text */
/**
 * A remark at its place in the text.
 *
 * @typedef {object} Mark
 * @property {number} from
 * @property {number} to
 * @property {"error" | "warning"} severity
 * @property {string} message
 * @property {string} [kind]       of the message
 * @property {string} [hint]       what was probably meant
 * @property {string} [hintKind]
 * @property {Repair | null} [repair]
 */

/**
 * Diagnostics as text ranges; one without position is placed at the start of the text.
 *
 * @param {string} text
 * @param {Pick<Verdict, "errors" | "warnings">} verdict
 * @returns {Mark[]}
 */
export function marks(text, { errors, warnings }) {
  const lines = text.split("\n");
  /** @type {number[]} */ const starts = [];
  let at = 0;
  for (const line of lines) {
    starts.push(at);
    at += line.length + 1;
  }
  /** The offset of a position, and of a number of characters after it in its line.
   * @param {number | null} line @param {number | null} column @param {number} length */
  const range = (line, column, length) => {
    const index = Math.min(Math.max((line ?? 1) - 1, 0), lines.length - 1);
    const points = [...lines[index]]; // columns count characters, not UTF-16 units
    const first = Math.max((column ?? 1) - 1, 0);
    const before = points.slice(0, first).join("").length;
    const under = points.slice(first, first + length).join("").length;
    const from = starts[index] + before;
    return { from, to: from + under };
  };
  /** @param {Remark} remark @param {Mark["severity"]} severity @returns {Mark} */
  const mark = ({ line, column, length = 1, message, kind, hint }, severity) => {
    const edit = hint?.edit ?? null;
    const repair = edit && {
      from: range(edit.line, edit.column, 0).from,
      to: range(edit.end_line, edit.end_column, 0).from,
      insert: edit.text,
    };
    const place = { ...range(line, column, Math.max(length, 1)), severity, message, ...(kind ? { kind } : {}) };
    return hint ? { ...place, hint: hint.message, hintKind: hint.kind, repair } : place;
  };
  const found = [
    ...errors.map((remark) => mark(remark, "error")),
    ...warnings.map((remark) => mark(remark, "warning")),
  ];
  return found.sort((one, other) => one.from - other.from);
}
