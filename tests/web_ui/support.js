// Captured messages, and small helpers of the page's tests.

import { readFileSync } from "node:fs";

/** @typedef {{ schemaName: string, schema: string, hex: string, value: any }} Captured */

/** Messages as rclpy serialized them (capture.py). @type {Captured[]} */
export const CAPTURED = JSON.parse(readFileSync(new URL("../data/web/messages.json", import.meta.url), "utf8"));

/** The captured message of a type. @param {string} schemaName */
export function captured(schemaName) {
  const found = CAPTURED.find((message) => message.schemaName === schemaName);
  if (found === undefined) throw new Error(`no captured ${schemaName}`);
  return found;
}

/** @param {string} hex */
export function bytes(hex) {
  return new Uint8Array(Buffer.from(hex, "hex"));
}

/** @param {Uint8Array} data */
export function view(data) {
  return new DataView(data.buffer, data.byteOffset, data.byteLength);
}

/**
 * A binary frame of the server: an opcode, then numbers by size, then a payload.
 *
 * @param {number} code
 * @param {[1 | 4 | 8, number | bigint][]} numbers
 * @param {Uint8Array} [payload]
 * @returns {ArrayBuffer}
 */
export function serverFrame(code, numbers, payload = new Uint8Array()) {
  const head = Buffer.alloc(1 + numbers.reduce((sum, [size]) => sum + size, 0));
  head.writeUInt8(code, 0);
  let at = 1;
  for (const [size, value] of numbers) {
    if (size === 1) head.writeUInt8(Number(value), at);
    else if (size === 4) head.writeUInt32LE(Number(value), at);
    else head.writeBigUInt64LE(BigInt(value), at);
    at += size;
  }
  return new Uint8Array(Buffer.concat([head, payload])).buffer;
}

/** A browser's storage in memory. @param {Record<string, string>} [content] */
export function newStorage(content = {}) {
  const kept = new Map(Object.entries(content));
  return {
    kept,
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ value) => void kept.set(key, value),
    removeItem: (/** @type {string} */ key) => void kept.delete(key),
  };
}
