// A program, playground or mission inside a link: the part of an address after `#share=`, which browsers send to no server.
// No DOM.
//
//     1.<number of the characters of DATA, in base 36>.<DATA>
//
// DATA is base64url of a zlib stream: a line of JSON with kind and name, then the content. The number recognizes a link
// that was cut, and what a mail program has added to its end; the checksum of zlib recognizes a changed one.

/** @typedef {"program" | "playground" | "mission"} Kind */
/** @typedef {{ kind: Kind, name: string, content: Uint8Array<ArrayBuffer> }} Item   name: of a file, as its author wrote it */

/** @type {readonly Kind[]} */
export const KINDS = ["program", "playground", "mission"];
/** Parameter of the fragment. */
export const PARAMETER = "share";
/** Parameter of a link to what the teacher of a class has handed out: its id. */
export const HANDOUT = "handout";
/** Characters of a link; mail and chat programs cut longer ones. */
export const LONGEST_LINK = 30_000;
/** Bytes of a link that a camera still reads from a screen: a QR code of version 30 with error correction L. */
export const LONGEST_QR = 1732;
/** Bytes of a content: more is no program or playground of this page, but an attack. */
export const LARGEST = 3_000_000;
/** Characters of a name. */
const LONGEST_NAME = 200;
const VERSION = "1";

/** Whether an item is a mission of the simulator itself: a class hands it out by its name. @param {Pick<Item, "content">} item */
export const isShipped = ({ content }) => content.length === 0;

/** A link that cannot be opened; `key` of a text with `values` says why. */
export class LinkError extends Error {
  /** @param {string} key @param {Record<string, string | number>} [values] */
  constructor(key, values = {}) {
    super(key);
    this.key = key;
    this.values = values;
  }
}

/** The item as the value of `#share=`. @param {Item} item */
export async function packed({ kind, name, content }) {
  const head = new TextEncoder().encode(`${JSON.stringify({ kind, name: name.slice(0, LONGEST_NAME) })}\n`);
  const stream = new Blob([head, content]).stream().pipeThrough(new CompressionStream("deflate"));
  const data = base64url(new Uint8Array(await new Response(stream).arrayBuffer()));
  return `${VERSION}.${data.length.toString(36)}.${data}`;
}

/**
 * The value of `#share=`, or of another parameter, in an address or in a text with one; null if there is none.
 *
 * @param {string} text
 */
export function sharedPart(text, parameter = PARAMETER) {
  const found = new RegExp(`[#&]${parameter}=([^&]*)`).exec(text);
  return found === null ? null : found[1];
}

/**
 * The item in the value of `#share=`. Throws LinkError.
 *
 * @param {string} part
 * @returns {Promise<Item>}
 */
export async function unpacked(part) {
  const [version, length, ...rest] = part.replace(/\s+/g, "").split("."); // mail programs break lines
  if (!/^\d+$/.test(version)) throw new LinkError("bad.damaged");
  if (version !== VERSION) throw new LinkError("bad.version");
  const expected = /^[0-9a-z]{1,6}$/.test(length ?? "") ? Number.parseInt(length, 36) : Number.NaN;
  if (Number.isNaN(expected) && rest.length > 0) throw new LinkError("bad.damaged");
  const data = rest.join(".").slice(0, expected);
  if (rest.length === 0 || data.length < expected) {
    throw new LinkError("bad.cut", { found: data.length, expected: expected || "?" });
  }
  const bytes = await inflated(bytesOf(data));
  const end = bytes.indexOf(10);
  const { kind, name } = headOf(new TextDecoder().decode(bytes.subarray(0, Math.max(end, 0))));
  return { kind, name, content: bytes.slice(end + 1) };
}

/** @param {string} line @returns {{ kind: Kind, name: string }} */
function headOf(line) {
  /** @type {any} */ let head = null;
  try {
    head = JSON.parse(line);
  } catch {
    // below
  }
  const { kind, name } = head ?? {};
  if (typeof kind !== "string" || typeof name !== "string") throw new LinkError("bad.damaged");
  const known = KINDS.find((each) => each === kind);
  if (known === undefined) throw new LinkError("bad.kind", { kind: kind.slice(0, 40) });
  return { kind: known, name: name.slice(0, LONGEST_NAME) };
}

/** @param {Uint8Array<ArrayBuffer>} bytes  a zlib stream */
async function inflated(bytes) {
  /** @type {ReadableStream<Uint8Array<ArrayBuffer>>} */
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  const reader = stream.getReader();
  /** @type {Uint8Array<ArrayBuffer>[]} */ const chunks = [];
  let size = 0;
  for (;;) {
    // Few bytes can become gigabytes: it is read in chunks, and no further than the limit.
    const { done, value } = await reader.read().catch(() => {
      throw new LinkError("bad.damaged");
    });
    if (done) return new Uint8Array(await new Blob(chunks).arrayBuffer());
    chunks.push(value);
    size += value.length;
    if (size > LARGEST + LONGEST_NAME * 10) {
      await reader.cancel();
      throw new LinkError("bad.tooLarge", { size: LARGEST / 1_000_000 });
    }
  }
}

/** @param {Uint8Array} bytes */
function base64url(bytes) {
  let letters = "";
  for (const byte of bytes) letters += String.fromCharCode(byte);
  return btoa(letters).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

/** @param {string} text  base64url */
function bytesOf(text) {
  if (!/^[\w-]*$/.test(text)) throw new LinkError("bad.damaged");
  try {
    return Uint8Array.from(atob(text.replaceAll("-", "+").replaceAll("_", "/")), (letter) => letter.charCodeAt(0));
  } catch {
    throw new LinkError("bad.damaged");
  }
}
