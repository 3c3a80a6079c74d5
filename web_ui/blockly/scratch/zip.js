// Reads one file of a ZIP archive, with the platform's decompression (APPNOTE.TXT of the format: sections 4.3.7,
// 4.3.12, 4.3.16).

/** The archive cannot be read. */
export class ZipError extends Error {
  /** @param {string} what */
  constructor(what) {
    super(what);
    this.name = "ZipError";
  }
}

const END = 0x06054b50;
const ENTRY = 0x02014b50;
const LOCAL = 0x04034b50;
const END_SIZE = 22;
const LONGEST_COMMENT = 0xffff;
const STORED = 0;
const DEFLATED = 8;
/** A file that unpacks to more is refused. */
const LARGEST = 64 * 1024 * 1024;

/**
 * The bytes of a file, which may be in a folder of the archive. Throws ZipError.
 *
 * @param {Uint8Array} archive
 * @param {string} name
 * @returns {Promise<Uint8Array>}
 */
export async function readZip(archive, name) {
  const view = new DataView(archive.buffer, archive.byteOffset, archive.byteLength);
  const end = findEnd(view);
  let at = view.getUint32(end + 16, true);
  for (let count = view.getUint16(end + 10, true); count > 0; count--) {
    if (at + 46 > view.byteLength || view.getUint32(at, true) !== ENTRY)
      throw new ZipError("the list of files is damaged");
    const [nameSize, extraSize, commentSize] = [28, 30, 32].map((offset) => view.getUint16(at + offset, true));
    const found = new TextDecoder().decode(archive.subarray(at + 46, at + 46 + nameSize));
    if (found === name || found.endsWith(`/${name}`)) return unpack(archive, view, at);
    at += 46 + nameSize + extraSize + commentSize;
  }
  throw new ZipError(`found no ${name} in the archive`);
}

/** @param {DataView} view */
function findEnd(view) {
  for (let at = view.byteLength - END_SIZE; at >= Math.max(0, view.byteLength - END_SIZE - LONGEST_COMMENT); at--) {
    if (view.getUint32(at, true) === END) return at;
  }
  throw new ZipError("found no ZIP archive");
}

/** @param {Uint8Array} archive @param {DataView} view @param {number} entry */
async function unpack(archive, view, entry) {
  const method = view.getUint16(entry + 10, true);
  const [packed, size, local] = [20, 24, 42].map((offset) => view.getUint32(entry + offset, true));
  if (size > LARGEST) throw new ZipError(`found ${size} bytes, expected at most ${LARGEST}`);
  if (local + 30 > view.byteLength || view.getUint32(local, true) !== LOCAL) throw new ZipError("a file is damaged");
  const start = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
  const data = archive.subarray(start, start + packed);
  if (data.length < packed) throw new ZipError("the archive is incomplete");
  if (method === STORED) return data;
  if (method !== DEFLATED) throw new ZipError(`found compression ${method}, expected ${STORED} or ${DEFLATED}`);
  return inflate(data, size);
}

/** @param {Uint8Array} data @param {number} size */
async function inflate(data, size) {
  const stream = new Blob([/** @type {Uint8Array<ArrayBuffer>} */ (data)])
    .stream()
    .pipeThrough(new DecompressionStream("deflate-raw"));
  const result = new Uint8Array(size);
  let filled = 0;
  try {
    for (const reader = stream.getReader(); ;) {
      const { done, value } = await reader.read();
      if (done) break;
      if (filled + value.length > size) throw new ZipError("a file is larger than the archive says");
      result.set(value, filled);
      filled += value.length;
    }
  } catch (error) {
    if (error instanceof ZipError) throw error;
    throw new ZipError("a file is damaged");
  }
  if (filled !== size) throw new ZipError("a file is smaller than the archive says");
  return result;
}
