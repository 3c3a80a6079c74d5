// The text of a file: in the encoding that its first bytes or its XML declaration say, else in UTF-8.

const MARKS = /** @type {const} */ ([
  ["utf-16le", 0xff, 0xfe],
  ["utf-16be", 0xfe, 0xff],
  ["utf-16le", 0x3c, 0], // "<" of XML without a mark
  ["utf-16be", 0, 0x3c],
]);
const DECLARED = /^(\s*<\?xml\s[^>]*?encoding\s*=\s*["'])([A-Za-z0-9._-]+)/;
const HEAD = 200; // bytes in which a declaration ends

/** @param {File} file @returns {Promise<string | null>}  null for what cannot be read as text */
export async function textOf(file) {
  try {
    return decoded(new Uint8Array(await file.arrayBuffer()));
  } catch {
    return null;
  }
}

/**
 * The text, without byte order mark. Here it is written back in UTF-8, and so it says.
 *
 * @param {Uint8Array} bytes
 * @returns {string}  TypeError for what is no text in its encoding, RangeError for an encoding that nobody knows
 */
export function decoded(bytes) {
  const head = new TextDecoder("iso-8859-1").decode(bytes.subarray(0, HEAD));
  const [marked] = MARKS.find(([, first, second]) => bytes[0] === first && bytes[1] === second) ?? [];
  const declared = DECLARED.exec(head)?.[2] ?? "utf-8";
  const encoding = marked ?? (/^utf-?16/i.test(declared) ? "utf-8" : declared); // UTF-16 could not be read so
  const text = new TextDecoder(encoding, { fatal: true }).decode(bytes);
  return /^utf-?8$/i.test(marked ?? declared) ? text : text.replace(DECLARED, "$1UTF-8");
}
