import assert from "node:assert/strict";
import { test } from "node:test";

import { Speaker } from "../../web_ui/sound/speaker.js";
import { goesOn, TRIANGLE, voiceOf, waveform } from "../../web_ui/sound/voice.js";
import { INITIAL, reduce } from "../../web_ui/state/index.js";
import { NEW_ROBOT } from "../../web_ui/state/robot.js";
import { FakeAudio } from "./audio.js";

/** @typedef {import("../../web_ui/state/index.js").State} State */

const START = /** @type {State} */ ({ ...INITIAL, connection: "connected", robots: { "": NEW_ROBOT } });

/** @param {State} state @param {string} topic @param {number[]} data */
function stateAfter(state, topic, data) {
  return reduce(state, { type: "message", topic, value: { data }, timeNs: 0n });
}

/** A speaker that a person has touched, on a fake loudspeaker. */
function prepared({ muted = false } = {}) {
  const audio = new FakeAudio();
  const speaker = new Speaker({ createContext: () => /** @type {any} */ (audio), muted, changed: () => {} });
  speaker.update(START);
  speaker.unlock();
  return { audio, speaker };
}

test("the default wave is a triangle", () => {
  assert.equal(TRIANGLE.length, 142);
  assert.ok(Math.max(...TRIANGLE) >= 125 && Math.min(...TRIANGLE) <= -125 && TRIANGLE[0] === 0);
});

test("zeros are silence, a frequency is a tone of the robot's wave", () => {
  assert.equal(voiceOf(NEW_ROBOT), null);
  const wave = Array.from({ length: 142 }, (_, at) => (at < 71 ? 127 : -128));
  const voice = voiceOf({ ...NEW_ROBOT, wave, sound: [440, 0.5, 0.25] });
  assert.deepEqual(voice, { kind: "tone", frequency: 440, data: wave, volume: 0.25 });
});

test("samples are played once the matching ones have arrived", () => {
  const samples = Array.from({ length: 7813 }, () => 200);
  assert.equal(voiceOf({ ...NEW_ROBOT, sound: [0, 1, 1] }), null);
  assert.equal(voiceOf({ ...NEW_ROBOT, sound: [0, 1, 1], samples: samples.slice(100) }), null);
  assert.equal(voiceOf({ ...NEW_ROBOT, sound: [0, 1, 1], samples })?.kind, "samples");
});

test("waves rest at 0, samples at 128", () => {
  const tone = { kind: /** @type {const} */ ("tone"), frequency: 440, data: [0, 64, -128], volume: 1 };
  assert.deepEqual([...waveform(tone)], [0, 0.5, -1]);
  assert.deepEqual([...waveform({ ...tone, kind: "samples", data: [128, 192, 0] })], [0, 0.5, -1]);
});

test("a sound continues when only its volume changes, and restarts when it is played again", () => {
  const samples = { kind: /** @type {const} */ ("samples"), frequency: 0, data: [1, 2], volume: 1 };
  assert.equal(goesOn(samples, { ...samples, data: [1, 2], volume: 0.5 }), true);
  assert.equal(goesOn(samples, { ...samples, data: [1, 2] }), false);
  assert.equal(goesOn(samples, { ...samples, data: [1, 3], volume: 0.5 }), false);
  assert.equal(goesOn(null, samples), false);
});

test("a tone sounds until the simulator reports its end", () => {
  const { audio, speaker } = prepared();
  const tone = stateAfter(START, "/_sound/state", [880, 0.2, 0.5]);
  speaker.update(tone);
  const [source] = audio.sounding;
  assert.equal(source.loop, true);
  assert.equal(source.gain.value, 0.5);
  assert.ok(Math.abs((source.playbackRate.value * source.buffer.sampleRate) / source.buffer.length - 880) < 1e-9);
  speaker.update(stateAfter(tone, "/_sound/state", [0, 0, 0.5]));
  assert.equal(audio.sounding.length, 0);
});

test("another volume does not restart the tone", () => {
  const { audio, speaker } = prepared();
  const tone = stateAfter(START, "/_sound/state", [880, 0.2, 1]);
  speaker.update(tone);
  speaker.update(stateAfter(tone, "/_sound/state", [880, 0.2, 0.125]));
  assert.equal(audio.sources.length, 1);
  assert.equal(audio.sources[0].gain.value, 0.125);
});

test("samples are played at their rate times the real-time factor", () => {
  for (const [factor, speed] of [
    [1, 1],
    [2, 2],
    [10, 4],
  ]) {
    const { audio, speaker } = prepared();
    const reported = JSON.stringify({ real_time_factor: factor });
    let state = reduce(START, { type: "message", topic: "/simulator/_state", value: { data: reported }, timeNs: 0n });
    const samples = Array.from({ length: 78 }, (_, at) => at);
    state = stateAfter(stateAfter(state, "/_sound/state/samples", samples), "/_sound/state", [0, 0.01, 1]);
    speaker.update(state);
    const [source] = audio.sounding;
    assert.equal(source.loop, false);
    assert.equal(source.playbackRate.value * source.buffer.sampleRate, 7812.5 * speed);
  }
});

test("two robots are heard together; a removed one falls silent", () => {
  const { audio, speaker } = prepared();
  const robots = { a: { ...NEW_ROBOT, sound: [440, 1, 1] }, b: { ...NEW_ROBOT, sound: [550, 1, 1] } };
  speaker.update({ ...START, robots });
  assert.equal(audio.sounding.length, 2);
  speaker.update({ ...START, robots: { a: robots.a } });
  assert.equal(audio.sounding.length, 1);
});

test("nothing sounds after the connection is lost", () => {
  const { audio, speaker } = prepared();
  const tone = stateAfter(START, "/_sound/state", [440, Infinity, 1]);
  speaker.update(tone);
  speaker.update(reduce(tone, { type: "disconnected" }));
  assert.equal(audio.sounding.length, 0);
});

test("a pause suspends sounds", () => {
  const { audio, speaker } = prepared();
  const tone = stateAfter(START, "/_sound/state", [440, 1, 1]);
  /** @param {boolean} paused */
  const with_ = (paused) =>
    reduce(tone, {
      type: "message",
      topic: "/simulator/_state",
      value: { data: JSON.stringify({ paused }) },
      timeNs: 0n,
    });
  speaker.update(tone);
  speaker.update(with_(true));
  assert.equal(audio.state, "suspended");
  speaker.update(with_(false));
  assert.equal(audio.state, "running");
  assert.equal(audio.sources.length, 1);
});

test("no audio context is created before the first user action, nor while muted", () => {
  let opened = 0;
  const createContext = () => {
    opened += 1;
    return /** @type {any} */ (new FakeAudio());
  };
  const waiting = new Speaker({ createContext, muted: false, changed: () => {} });
  waiting.update(stateAfter(START, "/_sound/state", [440, 1, 1]));
  assert.deepEqual([opened, waiting.phase], [0, "waiting"]);
  waiting.unlock();
  assert.deepEqual([opened, waiting.phase, waiting.playing.size], [1, "on", 1]);
  const muted = new Speaker({ createContext, muted: true, changed: () => {} });
  muted.unlock();
  assert.deepEqual([opened, muted.phase], [1, "muted"]);
  assert.equal(new Speaker({ createContext: null, muted: false, changed: () => {} }).phase, "unavailable");
});

test("muting stops sounds, and unmuting restarts them", () => {
  const { audio, speaker } = prepared();
  speaker.update(stateAfter(START, "/_sound/state", [440, Infinity, 1]));
  speaker.setMuted(true);
  assert.equal(audio.sounding.length, 0);
  speaker.setMuted(false);
  assert.equal(audio.sounding.length, 1);
});
