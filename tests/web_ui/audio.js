// A stand-in for Web Audio that notes what is played; for Node, and for a real page where nothing can be heard.

export class FakeAudio {
  constructor() {
    this.state = "running";
    this.currentTime = 0;
    this.destination = {};
    /** @type {any[]} */ this.sources = [];
  }

  /** Sources that still sound. */
  get sounding() {
    return this.sources.filter(({ stopped }) => !stopped);
  }

  createGain() {
    const gain = { value: 1, setTargetAtTime: (/** @type {number} */ value) => (gain.value = value) };
    return { gain, connect() {} };
  }

  /** @param {number} _channels @param {number} length @param {number} sampleRate */
  createBuffer(_channels, length, sampleRate) {
    const buffer = {
      length,
      sampleRate,
      /** @type {Float32Array | null} */ values: null,
      copyToChannel: (/** @type {Float32Array} */ values) => (buffer.values = values),
    };
    return buffer;
  }

  createBufferSource() {
    const source = {
      buffer: null,
      loop: false,
      playbackRate: { value: 1 },
      stopped: false,
      gain: null,
      connect: (/** @type {any} */ node) => (source.gain = node.gain),
      start: () => this.sources.push(source),
      stop: () => (source.stopped = true),
    };
    return source;
  }

  async suspend() {
    this.state = "suspended";
  }

  async resume() {
    this.state = "running";
  }
}
