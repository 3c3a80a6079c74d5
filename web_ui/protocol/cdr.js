// ROS 2 messages ↔ bytes: classic CDR (XCDR1), driven by a parsed `ros2msg` schema.
//
// A payload starts with four bytes that give the byte order; every number is aligned to its own
// size, counted from the end of this header. A type without fields occupies one byte, as in ROS 2.

/** @typedef {import("./ros2msg.js").Definition} Definition */
/** @typedef {import("./ros2msg.js").Field} Field */
/**
 * @typedef {object} Primitive
 * @property {number} size  bytes
 * @property {any} zero
 * @property {(view: DataView, at: number, littleEndian: boolean) => any} read
 * @property {(view: DataView, at: number, value: any) => void} write
 */

const HEADER_BYTES = 4;
const LITTLE_ENDIAN_HEADER = [0x00, 0x01, 0x00, 0x00];
const text = { decoder: new TextDecoder(), encoder: new TextEncoder() };

export class CdrError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "CdrError";
  }
}

/** One row per primitive type: its size, and how a DataView reads and writes it. */
const PRIMITIVES = /** @type {Record<string, Primitive>} */ ({
  bool: {
    size: 1,
    zero: false,
    read: (v, at) => v.getUint8(at) !== 0,
    write: (v, at, x) => v.setUint8(at, x ? 1 : 0),
  },
  int8: { size: 1, zero: 0, read: (v, at) => v.getInt8(at), write: (v, at, x) => v.setInt8(at, x) },
  uint8: { size: 1, zero: 0, read: (v, at) => v.getUint8(at), write: (v, at, x) => v.setUint8(at, x) },
  int16: { size: 2, zero: 0, read: (v, at, le) => v.getInt16(at, le), write: (v, at, x) => v.setInt16(at, x, true) },
  uint16: {
    size: 2,
    zero: 0,
    read: (v, at, le) => v.getUint16(at, le),
    write: (v, at, x) => v.setUint16(at, x, true),
  },
  int32: { size: 4, zero: 0, read: (v, at, le) => v.getInt32(at, le), write: (v, at, x) => v.setInt32(at, x, true) },
  uint32: {
    size: 4,
    zero: 0,
    read: (v, at, le) => v.getUint32(at, le),
    write: (v, at, x) => v.setUint32(at, x, true),
  },
  int64: {
    size: 8,
    zero: 0n,
    read: (v, at, le) => v.getBigInt64(at, le),
    write: (v, at, x) => v.setBigInt64(at, BigInt(x), true),
  },
  uint64: {
    size: 8,
    zero: 0n,
    read: (v, at, le) => v.getBigUint64(at, le),
    write: (v, at, x) => v.setBigUint64(at, BigInt(x), true),
  },
  float32: {
    size: 4,
    zero: 0,
    read: (v, at, le) => v.getFloat32(at, le),
    write: (v, at, x) => v.setFloat32(at, x, true),
  },
  float64: {
    size: 8,
    zero: 0,
    read: (v, at, le) => v.getFloat64(at, le),
    write: (v, at, x) => v.setFloat64(at, x, true),
  },
});

/**
 * Decode a message. Throws `CdrError` if bytes are missing or the representation is not supported.
 *
 * @param {Definition} definition
 * @param {DataView} payload
 * @returns {any}
 */
export function decode(definition, payload) {
  if (payload.byteLength < HEADER_BYTES) throw new CdrError(`a message of ${payload.byteLength} bytes has no header`);
  const kind = payload.getUint8(1);
  if (payload.getUint8(0) !== 0 || kind > 1)
    throw new CdrError(`representation ${payload.getUint16(0)} is not plain CDR`);
  return readFields(new Reader(payload, kind === 1), definition, definition.fields);
}

/**
 * Encode a message in little-endian CDR; missing fields are zero, empty or false.
 *
 * @param {Definition} definition
 * @param {Record<string, any>} value
 * @returns {Uint8Array}
 */
export function encode(definition, value) {
  const writer = new Writer();
  writeFields(writer, definition, definition.fields, value);
  return writer.bytes();
}

class Reader {
  /** @param {DataView} view @param {boolean} littleEndian */
  constructor(view, littleEndian) {
    this.view = view;
    this.littleEndian = littleEndian;
    this.offset = HEADER_BYTES;
  }

  /**
   * The aligned offset of the next value of `size` bytes, after checking that `count` bytes are available.
   *
   * @param {number} size
   * @param {number} count
   */
  claim(size, count = 1) {
    const start = this.offset + ((size - ((this.offset - HEADER_BYTES) % size)) % size);
    const end = start + size * count;
    if (end > this.view.byteLength) {
      throw new CdrError(`message ends at byte ${this.view.byteLength}, a value reaches to ${end}`);
    }
    this.offset = end;
    return start;
  }

  /** @param {string} type @returns {any} */
  primitive(type) {
    if (type === "string") return this.string();
    if (type === "wstring") return this.wstring();
    const { size, read } = PRIMITIVES[type];
    return read(this.view, this.claim(size), this.littleEndian);
  }

  string() {
    const length = this.primitive("uint32");
    const start = this.claim(1, length);
    const size = length > 0 && this.view.getUint8(start + length - 1) === 0 ? length - 1 : length;
    return text.decoder.decode(new Uint8Array(this.view.buffer, this.view.byteOffset + start, size));
  }

  wstring() {
    const length = this.primitive("uint32");
    let result = "";
    for (let index = 0; index < length; index++) result += String.fromCharCode(this.primitive("uint16"));
    return result;
  }

  /** @param {string} type @param {number} count */
  primitives(type, count) {
    /** @type {any[]} */
    const values = [];
    if (type === "string" || type === "wstring") {
      for (let index = 0; index < count; index++) values.push(this.primitive(type));
      return values;
    }
    if (count === 0) return values;
    const { size, read } = PRIMITIVES[type];
    let at = this.claim(size, count);
    for (let index = 0; index < count; index++, at += size) values.push(read(this.view, at, this.littleEndian));
    return values;
  }
}

/**
 * @param {Reader} reader
 * @param {Definition} definition
 * @param {Field[]} fields
 */
function readFields(reader, definition, fields) {
  if (fields.length === 0) {
    if (reader.offset < reader.view.byteLength) reader.claim(1);
    return {};
  }
  /** @type {Record<string, any>} */
  const value = {};
  for (const field of fields) {
    if (!field.isArray) {
      value[field.name] = field.complex
        ? readFields(reader, definition, fieldsOf(definition, field))
        : reader.primitive(field.type);
      continue;
    }
    const count = field.size ?? reader.primitive("uint32");
    if (!field.complex) {
      value[field.name] = reader.primitives(field.type, count);
      continue;
    }
    const nested = fieldsOf(definition, field);
    const list = [];
    for (let index = 0; index < count; index++) list.push(readFields(reader, definition, nested));
    value[field.name] = list;
  }
  return value;
}

class Writer {
  constructor() {
    this.view = new DataView(new ArrayBuffer(256));
    this.offset = HEADER_BYTES;
    LITTLE_ENDIAN_HEADER.forEach((byte, index) => this.view.setUint8(index, byte));
  }

  /** @param {number} size @param {number} count */
  claim(size, count = 1) {
    const start = this.offset + ((size - ((this.offset - HEADER_BYTES) % size)) % size);
    this.offset = start + size * count;
    if (this.offset > this.view.byteLength) {
      const larger = new Uint8Array(Math.max(this.offset, 2 * this.view.byteLength));
      larger.set(new Uint8Array(this.view.buffer));
      this.view = new DataView(larger.buffer);
    }
    return start;
  }

  /** @param {string} type @param {any} value */
  primitive(type, value) {
    if (type === "string") {
      const bytes = text.encoder.encode(value ?? "");
      this.primitive("uint32", bytes.length + 1);
      const start = this.claim(1, bytes.length + 1);
      new Uint8Array(this.view.buffer).set(bytes, start);
      return;
    }
    if (type === "wstring") {
      const units = String(value ?? "");
      this.primitive("uint32", units.length);
      for (let index = 0; index < units.length; index++) this.primitive("uint16", units.charCodeAt(index));
      return;
    }
    const { size, write, zero } = PRIMITIVES[type];
    const start = this.claim(size); // before `this.view` is read: the buffer may grow
    write(this.view, start, value ?? zero);
  }

  bytes() {
    return new Uint8Array(this.view.buffer, 0, this.offset).slice();
  }
}

/**
 * @param {Writer} writer
 * @param {Definition} definition
 * @param {Field[]} fields
 * @param {Record<string, any>} value
 */
function writeFields(writer, definition, fields, value) {
  if (fields.length === 0) writer.primitive("uint8", 0);
  for (const field of fields) {
    const given = value?.[field.name];
    const nested = field.complex ? fieldsOf(definition, field) : [];
    /** @param {any} item */
    const write = (item) => {
      if (field.complex) writeFields(writer, definition, nested, item ?? {});
      else writer.primitive(field.type, item);
    };
    if (!field.isArray) {
      write(given);
      continue;
    }
    const items = given ?? [];
    const count = field.size ?? items.length;
    if (field.size === null) writer.primitive("uint32", count);
    for (let index = 0; index < count; index++) write(items[index]);
  }
}

/** @param {Definition} definition @param {Field} field */
function fieldsOf(definition, field) {
  const fields = definition.types.get(field.type);
  if (fields === undefined) throw new CdrError(`type ${field.type} is not defined`);
  return fields;
}
