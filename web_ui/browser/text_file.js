// Decodes text files: by byte order mark or XML declaration, else as UTF-8.

const MARKS = /** @type {const} */ ([
  ["utf-16le", 0xff, 0xfe],
  ["utf-16be", 0xfe, 0xff],
]);
/** First bytes of a text in UTF-16 without a byte order mark, if it begins with two letters of ASCII. */
const UNMARKED = /** @type {const} */ ([
  ["utf-16le", /^[^\0]\0[^\0]\0/],
  ["utf-16be", /^\0[^\0]\0[^\0]/],
]);
const DECLARED = /^(\s*<\?xml\s[^>]*?encoding\s*=\s*["'])([A-Za-z0-9._-]+)/;
const HEAD = 200; // bytes that are searched for an XML declaration

/** @param {File} file @returns {Promise<string | null>}  null if the file cannot be decoded */
export async function textOf(file) {
  try {
    return decoded(new Uint8Array(await file.arrayBuffer()));
  } catch {
    return null;
  }
}

/**
 * Decode bytes to text without byte order mark. A declared encoding is rewritten to UTF-8, in which the text is saved.
 *
 * @param {Uint8Array} bytes
 * @returns {string}  throws TypeError for invalid bytes, RangeError for an unknown encoding
 */
export function decoded(bytes) {
  const head = new TextDecoder("iso-8859-1").decode(bytes.subarray(0, HEAD));
  const [marked] =
    MARKS.find(([, first, second]) => bytes[0] === first && bytes[1] === second) ??
    UNMARKED.find(([, pattern]) => pattern.test(head)) ??
    [];
  const declared = DECLARED.exec(head)?.[2] ?? "utf-8";
  const encoding = marked ?? (/^utf-?16/i.test(declared) ? "utf-8" : declared); // a readable declaration cannot be in UTF-16
  const text = new TextDecoder(encoding, { fatal: true }).decode(bytes);
  return /^utf-?8$/i.test(marked ?? declared) ? text : text.replace(DECLARED, "$1UTF-8");
}

/** The text of a file; characters that cannot be decoded become U+FFFD. @param {Uint8Array} bytes */
export function decodedOrMarked(bytes) {
  try {
    return decoded(bytes);
  } catch (error) {
    if (!(error instanceof TypeError || error instanceof RangeError)) throw error;
    return new TextDecoder().decode(bytes);
  }
}
