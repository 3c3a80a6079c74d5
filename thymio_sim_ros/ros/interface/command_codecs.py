"""Conversions between commands and messages, one pair per topic; `command_topics` assigns them to the topics.

Decoders raise CommandError for a message with a wrong number of values, with values that are not finite, or with values
that no command has. Values beyond a limit are clamped, here or by the actuator.
"""

from __future__ import annotations

import math

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

from thymio_sim_ros.ros.interface import command_checks, convert_readings, saturation
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.actuators.leds import LED_NUMBERS
from thymio_sim_ros.sim.actuators.pen import PEN_WIDTHS_M
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL
from thymio_sim_ros.sim.audio.synthesis import VOLUME_OFF, WAVE_LENGTH
from thymio_sim_ros.sim.commands import Command

ALIVE_S = 4.0
"""Period of the `alive` gesture. Modeling assumption."""

MAX_SAMPLES = 10 * 60 * 7813
"""Largest number of samples of one sound: ten minutes."""


def encode_targets(command: commands.MotorTargets) -> Int16MultiArray:
    """Return the message `[left, right]` in Thymio units."""
    return Int16MultiArray(data=[command.left, command.right])


def decode_targets(message: Int16MultiArray) -> Command:
    """Return the command for `[left, right]` in Thymio units."""
    return command_checks.motor_targets(message.data)


def encode_color(command: commands.SetLeds | commands.ReleaseLeds) -> ColorRGBA:
    """Return the color of a group with one light; a group that is released is black."""
    levels = command.levels if isinstance(command, commands.SetLeds) else (0, 0, 0)
    red, green, blue = (level / commands.LED_FULL for level in levels)
    return ColorRGBA(r=red, g=green, b=blue, a=1.0)


def decode_color(message: ColorRGBA, *, group: str) -> Command:
    """Return the command for a color; alpha is ignored."""
    return command_checks.led_levels(group, (message.r, message.g, message.b))


def encode_levels(command: commands.SetLeds | commands.ReleaseLeds) -> Float32MultiArray:
    """Return the intensities 0…1 of a group; an empty array returns it to firmware behavior."""
    levels = command.levels if isinstance(command, commands.SetLeds) else ()
    return Float32MultiArray(data=[level / commands.LED_FULL for level in levels])


def decode_levels(message: Float32MultiArray, *, group: str) -> Command:
    """Return the command for the intensities 0…1 of a group; an empty array returns it to firmware behavior."""
    return command_checks.led_levels(group, message.data) if len(message.data) else commands.ReleaseLeds(group)


def encode_single(command: commands.SetLed) -> Int16MultiArray:
    """Return the message `[number of the light, brightness 0…32]`."""
    return Int16MultiArray(data=[command.number, command.level])


def decode_single(message: Int16MultiArray) -> Command:
    """Return the command for `[number of the light, brightness 0…32]`. Raises CommandError for an unknown light."""
    number, level = command_checks.sized(message.data, 2, "[number of the light, brightness 0…32]")
    if not 0 <= number < len(LED_NUMBERS) or LED_NUMBERS[number] is None:
        none = ", ".join(str(place) for place, light in enumerate(LED_NUMBERS) if light is None)
        raise CommandError(f"found light {number}, expected 0 to {len(LED_NUMBERS) - 1}, but for {none}")
    return commands.SetLed(int(number), int(level))


def encode_own(command: commands.ShowOnLeds) -> Float32MultiArray:
    """Return the intensities that firmware behavior shows on a group; the label of the dimension is its name."""
    levels = [level / commands.LED_FULL for level in command.levels]
    return Float32MultiArray(layout=convert_readings.layout([(command.group, len(levels))]), data=levels)


def decode_own(message: Float32MultiArray) -> Command:
    """Return the command for the intensities that firmware behavior shows; raises CommandError for an unknown group."""
    group = message.layout.dim[0].label if message.layout.dim else ""
    if group not in commands.LED_GROUPS:
        raise CommandError(f"group {group!r} found in layout.dim[0].label, expected {', '.join(commands.LED_GROUPS)}")
    return commands.ShowOnLeds(group, command_checks.led_levels(group, message.data).levels)


def encode_tone(command: commands.PlayTone | commands.StopSound) -> Float32MultiArray:
    """Return the message `[Hz, s]`: 0 s until stopped, a negative time to stop."""
    if isinstance(command, commands.StopSound):
        return Float32MultiArray(data=[0.0, -1.0])
    return Float32MultiArray(data=[command.frequency_hz, (command.duration_ns or 0) / SECOND_NS])


def decode_tone(message: Float32MultiArray) -> Command:
    """Return the command for `[Hz, s]`; 0 s, or more than `MAX_TONE_S`, is until stopped, a negative time stops."""
    hertz, seconds = command_checks.sized(message.data, 2, "[Hz, s]")
    command_checks.finite(hertz, "frequency")
    command_checks.finite(seconds, "duration")
    if seconds < 0:
        return commands.StopSound()
    is_endless = seconds == 0.0 or seconds > saturation.MAX_TONE_S
    return commands.PlayTone(float(hertz), None if is_endless else round(seconds * SECOND_NS) or None)


def encode_system(command: commands.PlaySystemSound) -> Int8:
    """Return the number of a sound of the robot."""
    return Int8(data=max(-128, min(127, command.number)))


def decode_system(message: Int8) -> Command:
    """Return the command for a sound of the robot; -1 stops."""
    return commands.StopSound() if message.data == -1 else commands.PlaySystemSound(int(message.data))


def encode_samples(command: commands.PlaySamples) -> UInt8MultiArray:
    """Return unsigned 8 bit samples."""
    return UInt8MultiArray(data=command.samples)


def decode_samples(message: UInt8MultiArray) -> Command:
    """Return the command for at most `MAX_SAMPLES` unsigned 8 bit samples; raises CommandError for more."""
    if len(message.data) > MAX_SAMPLES:
        raise CommandError(f"found {len(message.data)} samples, expected at most {MAX_SAMPLES}")
    return commands.PlaySamples(bytes(message.data))


def encode_wave(command: commands.SetWave) -> Int8MultiArray:
    """Return the samples of one period."""
    return Int8MultiArray(data=list(command.samples))


def decode_wave(message: Int8MultiArray) -> Command:
    """Return the command for the `WAVE_LENGTH` samples of one period."""
    samples = command_checks.sized(message.data, WAVE_LENGTH, f"{WAVE_LENGTH} samples of one period")
    return commands.SetWave(tuple(int(sample) for sample in samples))


def encode_volume(command: commands.SetVolume) -> Int8:
    """Return the number of bits that samples lose."""
    return Int8(data=command.shift)


def decode_volume(message: Int8) -> Command:
    """Return the command for the number of bits that samples lose: 0 (loudest) to `VOLUME_OFF`.

    Raises CommandError outside this range.
    """
    if not 0 <= message.data <= VOLUME_OFF:
        raise CommandError(f"found {message.data}, expected 0 (loudest) to {VOLUME_OFF} (off)")
    return commands.SetVolume(int(message.data))


def encode_threshold(command: commands.SetSoundThreshold) -> Float32:
    """Return the threshold as a part of `FULL_LEVEL`."""
    return Float32(data=command.level / FULL_LEVEL)


def decode_threshold(message: Float32) -> Command:
    """Return the command for a threshold in parts of `FULL_LEVEL`; no sound is louder than 1."""
    command_checks.finite(message.data, "threshold")
    return commands.SetSoundThreshold(max(-0x8000, min(0x7FFF, round(message.data * FULL_LEVEL))))


def encode_enable(command: commands.EnableComm) -> Bool:
    """Return whether infrared communication is on."""
    return Bool(data=command.is_enabled)


def decode_enable(message: Bool) -> Command:
    """Return the command to switch infrared communication on or off."""
    return commands.EnableComm(bool(message.data))


def encode_payload(command: commands.SetCommPayload) -> Int16:
    """Return the value that is sent by infrared."""
    return Int16(data=command.value)


def decode_payload(message: Int16) -> Command:
    """Return the command for the value that is sent by infrared."""
    return commands.SetCommPayload(int(message.data))


def decode_gesture(message: Float32, *, name: str) -> Command:
    """Return the command for a gesture from its period in s; the sign is the direction.

    Raises CommandError for a period out of range.
    """
    try:
        return commands.PlayGesture(name, float(message.data))
    except ValueError as error:
        raise CommandError(str(error)) from error


def decode_alive(_message: Empty) -> Command:
    """Return the command for the gesture that shows that the robot is on."""
    return commands.PlayGesture("alive", ALIVE_S)


def decode_still(_message: Empty) -> Command:
    """Return the command that ends a gesture."""
    return commands.StopGesture()


def decode_alarm(message: Bool) -> Command:
    """Return the command to switch the alarm on or off."""
    return commands.SetAlarm(bool(message.data))


def decode_pen_down(message: Bool) -> Command:
    """Return the command to lower or lift the pen."""
    return commands.SetPen(down=bool(message.data))


def decode_pen_color(message: ColorRGBA) -> Command:
    """Return the command for a color to draw with, clamped to 0…1; alpha 0 is the eraser."""
    for value in (message.r, message.g, message.b, message.a):
        command_checks.finite(value, "color")
    red, green, blue = (min(max(value, 0.0), 1.0) for value in (message.r, message.g, message.b))
    return commands.SetPen(color=(red, green, blue), erase=message.a <= 0.0)


def decode_pen_width(message: Float32) -> Command:
    """Return the command for the width of the line in m; raises CommandError if it is out of range."""
    low, high = PEN_WIDTHS_M
    if not math.isfinite(message.data) or not low <= message.data <= high:
        raise CommandError(f"found {message.data:g} m, expected {low:g} to {high:g}")
    return commands.SetPen(width_m=float(message.data))
