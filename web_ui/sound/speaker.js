// Plays what the robots' loudspeakers say, through Web Audio. A browser lets nothing sound before a person has
// touched the page; a tone ends when the simulator says so, so that it lasts as long as in simulated time.

import { goesOn, SAMPLE_RATE, voiceOf, waveform, WAVE_LENGTH } from "./voice.js";

/** @typedef {import("./voice.js").Voice} Voice */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {{ voice: Voice, source: AudioBufferSourceNode, gain: GainNode }} Playing */
/** @typedef {"on" | "muted" | "waiting" | "unavailable"} Phase  waiting: for a person's first touch */

/** Browsers take no buffer below 8000 Hz; its speed makes up for that. */
const BUFFER_RATE = 8000;
/** One robot at full swing; several together stay below the limit. */
const LOUDNESS = 0.25;
const FADE_S = 0.004;
/** Samples follow the speed of time between these; beyond them they would only hiss or growl. */
const SPEEDS = { slowest: 0.25, fastest: 4 };

export class Speaker {
  /**
   * @param {object} options
   * @param {(() => AudioContext) | null} options.createContext  null where the browser has none
   * @param {boolean} options.muted
   * @param {() => void} options.changed   called when `phase` may have changed
   */
  constructor({ createContext, muted, changed }) {
    this.createContext = createContext;
    this.muted = muted;
    this.changed = changed;
    /** @type {AudioContext | null} */ this.context = null;
    /** @type {GainNode | null} */ this.master = null;
    /** @type {Map<string, Playing>} */ this.playing = new Map();
    /** @type {State | null} */ this.state = null;
  }

  /** @returns {Phase} */
  get phase() {
    if (this.createContext === null) return "unavailable";
    if (this.muted) return "muted";
    return this.context === null ? "waiting" : "on";
  }

  /** A person has touched the page: from now on it may sound. */
  unlock() {
    if (this.createContext === null || this.muted) return;
    if (this.context === null) {
      this.context = this.createContext();
      this.master = this.context.createGain();
      this.master.gain.value = LOUDNESS;
      this.master.connect(this.context.destination);
      this.changed();
    }
    this.#play();
  }

  /** @param {boolean} muted */
  setMuted(muted) {
    this.muted = muted;
    if (muted) this.#silence();
    else this.unlock();
    this.changed();
  }

  /** @param {State} state */
  update(state) {
    const before = this.state;
    this.state = state;
    if (
      before === null ||
      state.robots !== before.robots ||
      state.connection !== before.connection ||
      state.simulator !== before.simulator
    ) {
      this.#play();
    }
  }

  /** Let sound what is said, and nothing else. */
  #play() {
    const { context, state } = this;
    if (context === null || this.muted || state === null) return;
    const paused = state.simulator?.paused ?? false;
    // Time that stands still holds a sound where it is.
    if (paused && context.state === "running") void context.suspend();
    if (!paused && context.state !== "running") void context.resume();
    const connected = state.connection === "connected";
    for (const name of [...this.playing.keys()]) if (!connected || !(name in state.robots)) this.#stop(name);
    if (!connected) return;
    const speed = Math.min(SPEEDS.fastest, Math.max(SPEEDS.slowest, state.simulator?.factor ?? 1));
    for (const [name, robot] of Object.entries(state.robots)) {
      const voice = voiceOf(robot);
      const playing = this.playing.get(name);
      if (playing !== undefined && voice !== null && goesOn(playing.voice, voice)) {
        if (playing.voice.volume !== voice.volume) playing.gain.gain.value = voice.volume;
        playing.voice = voice;
        continue;
      }
      this.#stop(name);
      if (voice !== null) this.#start(name, voice, speed);
    }
  }

  /** @param {string} name @param {Voice} voice @param {number} speed */
  #start(name, voice, speed) {
    const { context, master } = this;
    if (context === null || master === null || voice.data.length === 0) return;
    const values = waveform(voice);
    const buffer = context.createBuffer(1, values.length, BUFFER_RATE);
    buffer.copyToChannel(values, 0);
    const source = context.createBufferSource();
    source.buffer = buffer;
    source.loop = voice.kind === "tone";
    source.playbackRate.value =
      voice.kind === "tone" ? (voice.frequency * WAVE_LENGTH) / BUFFER_RATE : (SAMPLE_RATE / BUFFER_RATE) * speed;
    const gain = context.createGain();
    gain.gain.value = voice.volume;
    source.connect(gain);
    gain.connect(master);
    source.start();
    this.playing.set(name, { voice, source, gain });
  }

  /** @param {string} name */
  #stop(name) {
    const playing = this.playing.get(name);
    if (playing === undefined || this.context === null) return;
    this.playing.delete(name);
    const now = this.context.currentTime;
    playing.gain.gain.setTargetAtTime(0, now, FADE_S); // no click
    playing.source.stop(now + 8 * FADE_S);
  }

  #silence() {
    for (const name of [...this.playing.keys()]) this.#stop(name);
  }
}
