// Plays the sounds of the robots through Web Audio. Browsers block sound before the first user action. A tone ends
// when the simulator reports its end, so that it lasts as long as in simulated time.

import { goesOn, SAMPLE_RATE, voiceOf, waveform, WAVE_LENGTH } from "./voice.js";

/** @typedef {import("./voice.js").Voice} Voice */
/** @typedef {import("../state/index.js").State} State */
/** @typedef {{ voice: Voice, source: AudioBufferSourceNode, gain: GainNode }} Playing */
/** @typedef {"on" | "muted" | "waiting" | "unavailable"} Phase  waiting: for the first user action */

/** Browsers reject buffers below 8000 Hz; the playback rate compensates for that. */
const BUFFER_RATE = 8000;
/** Gain of one robot at full amplitude; several together stay below the limit. */
const LOUDNESS = 0.25;
const FADE_S = 0.004;
/** Samples follow the real-time factor between these limits; beyond them they would be unintelligible. */
const SPEEDS = { slowest: 0.25, fastest: 4 };

export class Speaker {
  /**
   * @param {object} options
   * @param {(() => AudioContext) | null} options.createContext  null if the browser has no Web Audio
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

  /** Call on a user action: sound is allowed from now on. */
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

  /** Play exactly the reported sounds. */
  #play() {
    const { context, state } = this;
    if (context === null || this.muted || state === null) return;
    const paused = state.simulator?.paused ?? false;
    // While the simulation is paused, sounds are suspended.
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
    playing.gain.gain.setTargetAtTime(0, now, FADE_S); // avoids a click
    playing.source.stop(now + 8 * FADE_S);
  }

  #silence() {
    for (const name of [...this.playing.keys()]) this.#stop(name);
  }
}
