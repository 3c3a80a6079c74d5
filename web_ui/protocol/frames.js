// Binary frames of the Foxglove WebSocket protocol ↔ values (docs/spec/foxglove.md section 2).
// All numbers are little-endian; the first byte is the opcode.

/**
 * @typedef {{ op: "message", subscriptionId: number, timeNs: bigint, payload: DataView }
 *   | { op: "time", timeNs: bigint }
 *   | { op: "serviceResponse", serviceId: number, callId: number, encoding: string, payload: DataView }
 *   | { op: "other", code: number }} ServerFrame
 */

const SERVER_MESSAGE = 1;
const SERVER_TIME = 2;
const SERVER_SERVICE_RESPONSE = 3;
const CLIENT_MESSAGE = 1;
const CLIENT_SERVICE_REQUEST = 2;

const text = { decoder: new TextDecoder(), encoder: new TextEncoder() };

export class FrameError extends Error {
  /** @param {string} message */
  constructor(message) {
    super(message);
    this.name = "FrameError";
  }
}

/**
 * @param {ArrayBuffer} data
 * @returns {ServerFrame}
 */
export function parseFrame(data) {
  const view = new DataView(data);
  try {
    const code = view.getUint8(0);
    switch (code) {
      case SERVER_MESSAGE:
        return {
          op: "message",
          subscriptionId: view.getUint32(1, true),
          timeNs: view.getBigUint64(5, true),
          payload: new DataView(data, 13),
        };
      case SERVER_TIME:
        return { op: "time", timeNs: view.getBigUint64(1, true) };
      case SERVER_SERVICE_RESPONSE: {
        const length = view.getUint32(9, true);
        return {
          op: "serviceResponse",
          serviceId: view.getUint32(1, true),
          callId: view.getUint32(5, true),
          encoding: text.decoder.decode(new Uint8Array(data, 13, length)),
          payload: new DataView(data, 13 + length),
        };
      }
      default:
        return { op: "other", code };
    }
  } catch (error) {
    if (error instanceof RangeError) throw new FrameError(`a frame of ${data.byteLength} bytes is too short`);
    throw error;
  }
}

/**
 * A message published by this client.
 *
 * @param {number} channelId
 * @param {Uint8Array} payload
 */
export function messageFrame(channelId, payload) {
  const frame = new Uint8Array(5 + payload.length);
  const view = new DataView(frame.buffer);
  view.setUint8(0, CLIENT_MESSAGE);
  view.setUint32(1, channelId, true);
  frame.set(payload, 5);
  return frame;
}

/**
 * A service call of this client.
 *
 * @param {number} serviceId
 * @param {number} callId
 * @param {string} encoding
 * @param {Uint8Array} payload
 */
export function serviceRequestFrame(serviceId, callId, encoding, payload) {
  const name = text.encoder.encode(encoding);
  const frame = new Uint8Array(13 + name.length + payload.length);
  const view = new DataView(frame.buffer);
  view.setUint8(0, CLIENT_SERVICE_REQUEST);
  view.setUint32(1, serviceId, true);
  view.setUint32(5, callId, true);
  view.setUint32(9, name.length, true);
  frame.set(name, 13);
  frame.set(payload, 13 + name.length);
  return frame;
}
