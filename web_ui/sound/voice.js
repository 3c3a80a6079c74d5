// Converts the sound topics of a robot to a playable voice. Pure.
// 8-bit samples at 7812.5 Hz; tones use a wave of 142 samples (docs/spec/thymio-robot.md section 9).

/** @typedef {import("../state/robot.js").Robot} Robot */
/**
 * @typedef {object} Voice
 * @property {"tone" | "samples"} kind
 * @property {number} frequency   Hz of a tone; 0 for samples
 * @property {ArrayLike<number>} data   the wave, −128…127, or the samples, 0…255
 * @property {number} volume      0…1
 */

export const SAMPLE_RATE = 7812.5;
export const WAVE_LENGTH = 142;
const SILENCE = 128;
/** Samples and their duration arrive on two topics; they belong together if their durations agree to this. */
const SAME_LENGTH_S = 0.001;

/** The default wave: a triangle. */
export const TRIANGLE = Array.from({ length: WAVE_LENGTH }, (_, place) => {
  const phase = place / WAVE_LENGTH;
  const height = phase < 0.25 ? 4 * phase : phase < 0.75 ? 2 - 4 * phase : 4 * phase - 4;
  return Math.round(127 * height);
});

/** The current sound; null for silence, and while the samples of a sound have not arrived. @param {Robot} robot */
export function voiceOf({ sound, wave, samples }) {
  const [frequency, seconds, volume] = sound;
  if (frequency > 0) return /** @type {Voice} */ ({ kind: "tone", frequency, data: wave ?? TRIANGLE, volume });
  if (seconds <= 0 || samples === null) return null;
  if (Math.abs(samples.length / SAMPLE_RATE - seconds) > SAME_LENGTH_S) return null;
  return /** @type {Voice} */ ({ kind: "samples", frequency: 0, data: samples, volume });
}

/**
 * Whether the second voice continues the first, at most with another volume.
 *
 * @param {Voice | null} one
 * @param {Voice | null} two
 */
export function goesOn(one, two) {
  if (one === null || two === null || one.kind !== two.kind || one.frequency !== two.frequency) return false;
  if (one.data === two.data) return true;
  if (two.kind === "samples" && one.volume === two.volume) return false; // the same sound was started again
  return one.data.length === two.data.length && Array.from(one.data).every((value, at) => value === two.data[at]);
}

/** The values of a voice, −1…1. @param {Voice} voice */
export function waveform({ kind, data }) {
  const middle = kind === "tone" ? 0 : SILENCE;
  return Float32Array.from(data, (value) => (value - middle) / SILENCE);
}
