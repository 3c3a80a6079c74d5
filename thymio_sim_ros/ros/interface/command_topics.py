"""Command topics, one row per topic: conversions between commands and messages.

The simulator decodes messages and the Aseba runtime encodes commands of programs with the same rows
(docs/spec/ros-interface.md sections 4.2 and 6.3). Topics on which programs do not publish are rows without `encode`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from rclpy.qos import QoSProfile
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Int8,
    Int8MultiArray,
    Int16,
    Int16MultiArray,
    UInt8MultiArray,
)

from thymio_sim_ros.ros.interface import command_checks, convert_readings, qos, saturation
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.saturation import LimitCheck
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.actuators.leds import LED_NUMBERS
from thymio_sim_ros.sim.actuators.pen import PEN_WIDTHS_M
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL
from thymio_sim_ros.sim.audio.synthesis import VOLUME_OFF, WAVE_LENGTH
from thymio_sim_ros.sim.commands import Command

__all__ = ["BODY_LEDS", "ROWS", "CommandRow", "led_topic", "topic_of"]

BODY_LEDS = ("top", "bottom_left", "bottom_right")
"""Groups with a single color; their topics are those of the driver."""

ALIVE_S = 4.0
"""Period of the `alive` gesture. Modeling assumption."""
MAX_SAMPLES = 10 * 60 * 7813
"""Samples of one sound: ten minutes."""


@dataclass(frozen=True, slots=True)
class CommandRow:
    """One topic: `decode` gives the command of a message or raises CommandError.

    `encode` gives the message of a command; `topic` is then `topic_of(command)`. `about` is content and units for
    docs/ros.md. `limit_check` describes the part of a message that will be clamped. `is_retained`: the command stays in
    force until the next one, so late subscribers need it.
    """

    topic: str
    type: type
    decode: Callable[[Any], Command]
    encode: Callable[[Any], Any] | None = None
    profile: QoSProfile = field(default_factory=lambda: qos.COMMAND)
    about: str = ""
    limit_check: LimitCheck = saturation.nothing
    is_retained: bool = False


def led_topic(group: str) -> str:
    """Return the topic of a group of lights; all except body and circle are hidden."""
    if group in BODY_LEDS:
        return f"led/body/{group}"
    return "led/circle" if group == "circle" else f"_led/{group}"


def topic_of(command: Command) -> str | None:
    """Return the topic on which a program's command is published, or None if it has no topic."""
    if isinstance(command, commands.SetLeds | commands.ReleaseLeds):
        return led_topic(command.group)
    return _TOPICS.get(type(command))


_TOPICS: dict[type[Any], str] = {
    commands.MotorTargets: "_motor/target",
    commands.SetLed: "_led/single",
    commands.ShowOnLeds: "_led/own",
    commands.PlayTone: "sound/tone",
    commands.StopSound: "sound/tone",
    commands.PlaySystemSound: "_sound/system",
    commands.PlaySamples: "_sound/samples",
    commands.SetWave: "_sound/wave",
    commands.SetVolume: "_sound/volume",
    commands.SetSoundThreshold: "_sound_threshold",
    commands.EnableComm: "_comm/enable",
    commands.SetCommPayload: "_comm/tx",
}


def _encode_targets(command: commands.MotorTargets) -> Int16MultiArray:
    return Int16MultiArray(data=[command.left, command.right])


def _decode_targets(message: Int16MultiArray) -> Command:
    return command_checks.motor_targets(message.data)


def _encode_color(command: commands.SetLeds | commands.ReleaseLeds) -> ColorRGBA:
    levels = command.levels if isinstance(command, commands.SetLeds) else (0, 0, 0)
    red, green, blue = (level / commands.LED_FULL for level in levels)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)


def _decode_color(message: ColorRGBA, *, group: str) -> Command:
    return command_checks.led_levels(group, (message.r, message.g, message.b))


def _encode_levels(command: commands.SetLeds | commands.ReleaseLeds) -> Float32MultiArray:
    """An empty array returns a group to firmware behavior."""
    levels = command.levels if isinstance(command, commands.SetLeds) else ()
    return Float32MultiArray(data=[level / commands.LED_FULL for level in levels])


def _decode_levels(message: Float32MultiArray, *, group: str) -> Command:
    return command_checks.led_levels(group, message.data) if len(message.data) else commands.ReleaseLeds(group)


def _encode_single(command: commands.SetLed) -> Int16MultiArray:
    return Int16MultiArray(data=[command.number, command.level])


def _decode_single(message: Int16MultiArray) -> Command:
    number, level = command_checks.sized(message.data, 2, "[number of the light, brightness 0…32]")
    if not 0 <= number < len(LED_NUMBERS) or LED_NUMBERS[number] is None:
        none = ", ".join(str(place) for place, light in enumerate(LED_NUMBERS) if light is None)
        raise CommandError(f"light {number} found, expected 0 to {len(LED_NUMBERS) - 1}, but for {none}")
    return commands.SetLed(int(number), int(level))


def _encode_own(command: commands.ShowOnLeds) -> Float32MultiArray:
    levels = [level / commands.LED_FULL for level in command.levels]
    return Float32MultiArray(layout=convert_readings.layout([(command.group, len(levels))]), data=levels)


def _decode_own(message: Float32MultiArray) -> Command:
    group = message.layout.dim[0].label if message.layout.dim else ""
    if group not in commands.LED_GROUPS:
        raise CommandError(f"group {group!r} found in layout.dim[0].label, expected {', '.join(commands.LED_GROUPS)}")
    return commands.ShowOnLeds(group, command_checks.led_levels(group, message.data).levels)


def _encode_tone(command: commands.PlayTone | commands.StopSound) -> Float32MultiArray:
    if isinstance(command, commands.StopSound):
        return Float32MultiArray(data=[0.0, -1.0])
    return Float32MultiArray(data=[command.frequency_hz, (command.duration_ns or 0) / SECOND_NS])


def _decode_tone(message: Float32MultiArray) -> Command:
    """[Hz, s]; 0 s, or more than `MAX_TONE_S`, means until stopped; a negative time stops the sound."""
    hertz, seconds = command_checks.sized(message.data, 2, "[Hz, s]")
    command_checks.finite(hertz, "frequency")
    command_checks.finite(seconds, "duration")
    if seconds < 0:
        return commands.StopSound()
    is_endless = seconds == 0.0 or seconds > saturation.MAX_TONE_S
    return commands.PlayTone(float(hertz), None if is_endless else round(seconds * SECOND_NS) or None)


def _encode_system(command: commands.PlaySystemSound) -> Int8:
    return Int8(data=max(-128, min(127, command.number)))


def _decode_system(message: Int8) -> Command:
    return commands.StopSound() if message.data == -1 else commands.PlaySystemSound(int(message.data))


def _encode_samples(command: commands.PlaySamples) -> UInt8MultiArray:
    return UInt8MultiArray(data=command.samples)


def _decode_samples(message: UInt8MultiArray) -> Command:
    if len(message.data) > MAX_SAMPLES:
        raise CommandError(f"{len(message.data)} samples found, expected at most {MAX_SAMPLES}")
    return commands.PlaySamples(bytes(message.data))


def _encode_wave(command: commands.SetWave) -> Int8MultiArray:
    return Int8MultiArray(data=list(command.samples))


def _decode_wave(message: Int8MultiArray) -> Command:
    samples = command_checks.sized(message.data, WAVE_LENGTH, f"{WAVE_LENGTH} samples of one period")
    return commands.SetWave(tuple(int(sample) for sample in samples))


def _encode_volume(command: commands.SetVolume) -> Int8:
    return Int8(data=command.shift)


def _decode_volume(message: Int8) -> Command:
    if not 0 <= message.data <= VOLUME_OFF:
        raise CommandError(f"{message.data} found, expected 0 (loudest) to {VOLUME_OFF} (off)")
    return commands.SetVolume(int(message.data))


def _encode_threshold(command: commands.SetSoundThreshold) -> Float32:
    return Float32(data=command.level / FULL_LEVEL)


def _decode_threshold(message: Float32) -> Command:
    """0…1 of 255, or beyond: nothing is as loud."""
    command_checks.finite(message.data, "threshold")
    return commands.SetSoundThreshold(max(-0x8000, min(0x7FFF, round(message.data * FULL_LEVEL))))


def _encode_enable(command: commands.EnableComm) -> Bool:
    return Bool(data=command.is_enabled)


def _decode_enable(message: Bool) -> Command:
    return commands.EnableComm(bool(message.data))


def _encode_payload(command: commands.SetCommPayload) -> Int16:
    return Int16(data=command.value)


def _decode_payload(message: Int16) -> Command:
    return commands.SetCommPayload(int(message.data))


def _decode_gesture(message: Float32, *, name: str) -> Command:
    """Its period in s; the sign is the direction."""
    try:
        return commands.PlayGesture(name, float(message.data))
    except ValueError as error:
        raise CommandError(str(error)) from error


def _decode_alive(_message: Empty) -> Command:
    return commands.PlayGesture("alive", ALIVE_S)


def _decode_still(_message: Empty) -> Command:
    return commands.StopGesture()


def _decode_alarm(message: Bool) -> Command:
    return commands.SetAlarm(bool(message.data))


def _decode_pen_down(message: Bool) -> Command:
    return commands.SetPen(down=bool(message.data))


def _decode_pen_color(message: ColorRGBA) -> Command:
    """A color to draw with; alpha 0 is the eraser."""
    for value in (message.r, message.g, message.b, message.a):
        command_checks.finite(value, "color")
    red, green, blue = (min(max(value, 0.0), 1.0) for value in (message.r, message.g, message.b))
    return commands.SetPen(color=(red, green, blue), erase=message.a <= 0.0)


def _decode_pen_width(message: Float32) -> Command:
    low, high = PEN_WIDTHS_M
    if not math.isfinite(message.data) or not low <= message.data <= high:
        raise CommandError(f"{message.data:g} m found, expected {low:g} to {high:g}")
    return commands.SetPen(width_m=float(message.data))


def _rows() -> Iterator[CommandRow]:
    yield CommandRow(
        "_motor/target",
        Int16MultiArray,
        _decode_targets,
        _encode_targets,
        about="left, right in Thymio units, ±500; valid until the next command",
        limit_check=saturation.targets,
        is_retained=True,
    )
    for group in commands.LED_GROUPS:
        if group in BODY_LEDS:
            decode = partial(_decode_color, group=group)
            yield CommandRow(
                led_topic(group),
                ColorRGBA,
                decode,
                _encode_color,
                qos.LEDS,
                about="0…1; alpha is ignored",
                limit_check=saturation.color,
                is_retained=True,
            )
        else:
            decode = partial(_decode_levels, group=group)
            yield CommandRow(
                led_topic(group),
                Float32MultiArray,
                decode,
                _encode_levels,
                qos.LEDS,
                about=f"{commands.LED_GROUPS[group]} intensities 0…1; empty: firmware behavior",
                limit_check=saturation.intensities,
                is_retained=True,
            )
    yield CommandRow(
        "_led/single",
        Int16MultiArray,
        _decode_single,
        _encode_single,
        qos.LEDS,
        about="number of the light 0…39 (15 is none), brightness 0…32",
        limit_check=saturation.single,
        is_retained=True,
    )
    yield CommandRow(
        "_led/own",
        Float32MultiArray,
        _decode_own,
        _encode_own,
        qos.LEDS,
        about="firmware behavior of a group; its name is layout.dim[0].label",
        limit_check=saturation.intensities,
        is_retained=True,
    )
    for name in ("circle", "blink", "kit"):
        yield CommandRow(
            f"_led/gesture/{name}",
            Float32,
            partial(_decode_gesture, name=name),
            profile=qos.LEDS,
            about="period in s, its sign the direction",
        )
    yield CommandRow(
        "_led/gesture/alive",
        Empty,
        _decode_alive,
        profile=qos.LEDS,
        about="the slow gesture that shows that the robot is on",
    )
    yield CommandRow(
        "_led/gesture/off",
        Empty,
        _decode_still,
        profile=qos.LEDS,
        about="stop the gesture; lights return to firmware behavior",
    )
    yield CommandRow(
        "sound/tone",
        Float32MultiArray,
        _decode_tone,
        _encode_tone,
        qos.EVENTS,
        about="Hz, s; 0 s until stopped, a negative time stops",
        limit_check=saturation.tone,
    )
    yield CommandRow(
        "_sound/system",
        Int8,
        _decode_system,
        _encode_system,
        qos.EVENTS,
        about="the robot's sound 0…7, -1 stops",
        limit_check=saturation.system_sound,
    )
    yield CommandRow(
        "_sound/samples",
        UInt8MultiArray,
        _decode_samples,
        _encode_samples,
        qos.EVENTS,
        about="unsigned 8 bit at 7812.5 Hz, at most ten minutes",
    )
    yield CommandRow(
        "_sound/wave",
        Int8MultiArray,
        _decode_wave,
        _encode_wave,
        qos.EVENTS,
        about="the period that tones are made of, 142 samples",
        is_retained=True,
    )
    yield CommandRow(
        "_sound/volume",
        Int8,
        _decode_volume,
        _encode_volume,
        qos.EVENTS,
        about="bits that samples lose: 0 is loudest, 8 is off",
        is_retained=True,
    )
    yield CommandRow(
        "_sound_threshold",
        Float32,
        _decode_threshold,
        _encode_threshold,
        about="0…1 of 255: louder sounds are published on `_sound`; 0 is off",
        limit_check=saturation.threshold,
        is_retained=True,
    )
    yield CommandRow(
        "_comm/enable",
        Bool,
        _decode_enable,
        _encode_enable,
        about="infrared communication on or off",
        is_retained=True,
    )
    yield CommandRow(
        "_comm/tx",
        Int16,
        _decode_payload,
        _encode_payload,
        about="the value that is sent, 0…2047",
        limit_check=saturation.payload,
        is_retained=True,
    )
    yield CommandRow("_alarm", Bool, _decode_alarm, about="true: play the sound of an arrow button every three seconds")
    yield CommandRow("pen/down", Bool, _decode_pen_down, about="true: the pen draws")
    yield CommandRow(
        "_pen/color", ColorRGBA, _decode_pen_color, about="0…1; alpha 0 erases", limit_check=saturation.paint
    )
    yield CommandRow("_pen/width", Float32, _decode_pen_width, about="m, 0.001…0.1")


ROWS = tuple(_rows())
"""Every topic that carries commands one to one; robot_inputs adds those that need more than the message."""
