"""The loudspeaker (docs/spec/thymio-robot.md sections 6.3 and 9): tones of a wave, the robot's own sounds, samples.

One sound at a time; a new one replaces it. Its natural end, and only that, counts as finished.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.audio import synthesis
from thymio_sim_ros.sim.audio.synthesis import BLOCK_NS, BLOCK_SAMPLES, SAMPLE_NS, VOLUME_OFF, WAVE_LENGTH, Note
from thymio_sim_ros.sim.commands import (
    Command,
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    SetAlarm,
    SetVolume,
    SetWave,
    StopSound,
)
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, Native
from thymio_sim_ros.sim.plugin_api.view import ActuatorView

__all__ = ["ACTUATOR", "LoudspeakerState"]

ALARM_NS = 3_000_000_000
"""Between two sounds of an alarm (docs/spec/ros-interface.md section 4.2)."""
_NO_SOUND = b"\x80"
"""One sample of silence: a sound of no length ends, too."""
SHORTEST_TICKS = 4
"""Ticks of the shortest tone that a program can ask for (section 6.3)."""


@dataclass(slots=True)
class LoudspeakerState:
    """The present sound: a note, samples, or nothing.

    `sounding_level` is the swing of the samples that sound now, 0…255, as a microphone counts. `began_ns` is when the
    note or the samples began, `changes` counts what began, ended or changed, `finished` the sounds that ended by
    themselves. `alarm_ns` is when the alarm sounds again, None without one.
    """

    wave: tuple[int, ...] = synthesis.TRIANGLE
    shift: int = 0
    note: Note | None = None
    samples: bytes = b""
    began_ns: int = 0
    sounding_level: int = 0
    changes: int = 0
    finished: int = 0
    alarm_ns: int | None = None
    _waiting: tuple[Note, ...] = ()

    @property
    def is_silent(self) -> bool:
        """Whether nothing tones."""
        return self.note is None and not self.samples

    def sound_level(self, _now_ns: int) -> float:
        """The level near the robot; 0 is silent.

        Assumption: a loudspeaker at full swing drives the microphone beside it to full swing, as in classrooms, where
        tones start the clap rows of VPL, which need more than 250.
        """
        return self.sounding_level

    def play(self, notes: tuple[Note, ...], samples: bytes, now_ns: int) -> None:
        """Start to play notes or samples; without either, be silent."""
        self.note, self._waiting = (notes[0], notes[1:]) if notes else (None, ())
        self.samples = samples
        self.began_ns = now_ns
        self.changes += 1
        self._measure(now_ns)

    def go_on(self, now_ns: int) -> None:
        """Advance to this time: to the next note, or to the end."""
        while self.note is not None and self.note.duration_ns is not None:
            end_ns = self.began_ns + self.note.duration_ns
            if now_ns < end_ns:
                return
            self._next(self._waiting, end_ns)
        if self.samples:
            end_ns = self.began_ns + len(self.samples) * SAMPLE_NS
            if now_ns >= end_ns:
                self._next((), end_ns)
            else:
                self._measure(now_ns)

    def adjust(self, now_ns: int, *, wave: tuple[int, ...] | None = None, shift: int | None = None) -> None:
        """Change wave or volume, also of the sound that is playing."""
        self.wave = self.wave if wave is None else wave
        self.shift = self.shift if shift is None else shift
        self.changes += 1
        self._measure(now_ns)

    def _next(self, notes: tuple[Note, ...], now_ns: int) -> None:
        self.finished += not notes
        self.play(notes, b"", now_ns)

    def _measure(self, now_ns: int) -> None:
        first = (now_ns - self.began_ns) // SAMPLE_NS
        block: Sequence[int] = self.wave if self.note is not None else self.samples[first : first + BLOCK_SAMPLES]
        self.sounding_level = (max(block) - min(block)) >> self.shift if block else 0


def _apply(
    state: LoudspeakerState,
    command: PlayTone | PlaySystemSound | PlaySamples | StopSound | SetWave | SetVolume | SetAlarm,
    now_ns: int,
) -> None:
    match command:
        case PlayTone(frequency_hz, duration_ns):
            state.play((synthesis.tone(frequency_hz, duration_ns),), b"", now_ns)
        case PlaySystemSound(number):
            state.play(synthesis.system_sound(number), b"", now_ns)
        case PlaySamples(samples):
            state.play((), samples or _NO_SOUND, now_ns)
        case StopSound():
            if not state.is_silent:
                state.play((), b"", now_ns)
        case SetWave(samples=wave):
            if len(wave) != WAVE_LENGTH or not all(-128 <= sample <= 127 for sample in wave):
                raise ValueError(f"SetWave: found {len(wave)} samples, expected {WAVE_LENGTH} of -128 to 127")
            if wave != state.wave:
                state.adjust(now_ns, wave=wave)
        case SetAlarm(is_on):
            if is_on != (state.alarm_ns is not None):
                state.alarm_ns = now_ns if is_on else None
        case SetVolume(shift):
            if not 0 <= shift <= VOLUME_OFF:
                raise ValueError(f"SetVolume: found {shift}, expected 0 to {VOLUME_OFF}")
            if shift != state.shift:
                state.adjust(now_ns, shift=shift)


def _update(state: LoudspeakerState, view: ActuatorView, _dt_s: float) -> None:
    if state.alarm_ns is not None and view.now_ns >= state.alarm_ns:
        state.alarm_ns += ALARM_NS
        state.play(synthesis.system_sound(synthesis.ALARM), b"", view.now_ns)
        view.wake(LoudspeakerState)
    if not state.is_silent:
        changes = state.changes
        state.go_on(view.now_ns)
        if state.changes != changes:
            view.wake(LoudspeakerState)


def _frequency(words: Sequence[int]) -> Command:
    hertz, ticks = words
    if ticks < 0:
        return StopSound()
    return PlayTone(hertz, max(ticks, SHORTEST_TICKS) * BLOCK_NS if ticks else None)


def _wave(words: Sequence[int]) -> Command:
    wrong = next((word for word in words if not -128 <= word <= 127), None)
    if wrong is not None:
        raise ValueError(f"sound.wave: sample {wrong} found, expected -128 to 127")
    return SetWave(tuple(words))


ACTUATOR = Actuator(
    name="loudspeaker",
    accepts=(PlayTone, PlaySystemSound, PlaySamples, StopSound, SetWave, SetVolume, SetAlarm),
    begin=LoudspeakerState,
    apply=_apply,
    update=_update,
    is_idle=lambda state: state.is_silent and state.alarm_ns is None,
    aseba=ActuatorFace(
        natives=(
            Native("sound.freq", ("Hz", "1/60s"), _frequency, "Play a tone; 0: until stopped, negative: stop"),
            Native("sound.wave", (f"wave:{WAVE_LENGTH}",), _wave, "Set the wave of tones"),
        ),
        at_reset=(StopSound(), SetWave(synthesis.TRIANGLE)),
    ),
)
