// Requests to the services that check and load programs, and their answers.

/** @typedef {{ line: number, column: number, end_line: number, end_column: number, text: string }} Edit */
/** @typedef {{ kind: string, message: string, edit: Edit | null }} Hint  the probable intention */
/** @typedef {{ line: number | null, column: number | null, length?: number, message: string, kind?: string, hint?: Hint | null }} Remark */
/** @typedef {{ variables: [number, number], bytecode: [number, number], stack: [number, number] }} Use */
/**
 * @typedef {object} Verdict
 * @property {Remark[]} errors
 * @property {Remark[]} warnings
 * @property {Use | null} use
 * @property {{ name: string, size?: number }[]} variables
 */
/** @typedef {{ name: string, value: number }} Entry */

/** @typedef {{ text: string, line: number | null, column: number | null }} Fault */

export const CHECK_SERVICE = "/aseba_runtime/check";
export const LOAD_SERVICE = "/aseba_runtime/load";
const STRING = 4; // rcl_interfaces/msg/ParameterType
const BOOL = 1;
const STRING_ARRAY = 9;
/** Status of an answer to a request that failed. */
const NO_ANSWER = "request";

/**
 * Build a request of rcl_interfaces/srv/SetParametersAtomically.
 *
 * @param {{ source: string, language: string, events: Entry[], constants: Entry[] }} what
 */
export function checkRequest({ source, language, events, constants }) {
  /** @param {Entry[]} entries */
  const list = (entries) => ({
    type: STRING_ARRAY,
    string_array_value: entries.map(({ name, value }) => `${name} ${value}`),
  });
  return {
    parameters: [
      { name: "source", value: { type: STRING, string_value: source } },
      { name: "language", value: { type: STRING, string_value: language } },
      { name: "events", value: list(events) },
      { name: "constants", value: list(constants) },
    ],
  };
}

/** A request for the names that a robot offers, with help in this language. @param {string} language */
export function targetRequest(language) {
  return {
    parameters: [
      { name: "source", value: { type: STRING, string_value: "" } },
      { name: "language", value: { type: STRING, string_value: language } },
      { name: "target", value: { type: BOOL, bool_value: true } },
    ],
  };
}

/** A request whose parameters are texts. @param {Record<string, string>} texts */
export function textRequest(texts) {
  const parameters = Object.entries(texts).map(([name, text]) => ({
    name,
    value: { type: STRING, string_value: text },
  }));
  return { parameters };
}

/** What became of a program that was to be loaded. @param {any} answer @returns {import("./runtime_client.js").Loaded} */
export function readLoaded(answer) {
  const { successful, reason } = answer.result;
  const fault = firstFault(answer);
  const refusal = successful || reason === "" ? "" : (readVerdict(answer).errors[0]?.message ?? "");
  return { ok: successful, message: fault?.text ?? refusal, fault, notes: notesOf(answer) };
}

/** The first error of a whole file, translated; null if there is none. @param {any} answer @returns {Fault | null} */
function firstFault(answer) {
  const found = readVerdict(answer).errors.find(({ kind }) => kind !== NO_ANSWER);
  if (found === undefined) return null;
  const text = found.hint ? `${found.message} (${found.hint.message})` : found.message;
  return { text, line: found.line, column: found.column };
}

/** Notes about how the nodes of a file were interpreted, as sentences. @param {any} answer @returns {string[]} */
function notesOf(answer) {
  const { notes = [] } = parsed(answer);
  return notes.map((/** @type {{ message: string }} */ { message }) => message);
}

/** The errors of the text itself, without a check that failed. @param {Verdict | null} verdict */
export function mistakesIn(verdict) {
  return (verdict?.errors ?? []).filter(({ kind }) => kind !== NO_ANSWER);
}

/** @param {any} answer @returns {Verdict} */
export function readVerdict(answer) {
  const { errors = [], warnings = [], nodes = [] } = parsed(answer);
  return { errors, warnings, use: nodes[0]?.use ?? null, variables: nodes[0]?.variables ?? [] };
}

/** @param {any} answer */
function parsed(answer) {
  return JSON.parse(answer.result.reason || "{}");
}
