"""The topics that carry commands one to one, one row per topic.

The simulator decodes messages and the Aseba runtime encodes commands of programs with the same rows
(docs/spec/ros-interface.md sections 4.2 and 6.3). Topics on which programs do not publish are rows without `encode`.
"""

from __future__ import annotations

from functools import partial

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

from thymio_sim_ros.ros.interface import command_codecs as codecs
from thymio_sim_ros.ros.interface import qos, saturation
from thymio_sim_ros.ros.interface.command_row import CommandRow
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command

__all__ = ["BODY_LEDS", "ROWS", "led_topic", "topic_of"]

BODY_LEDS = ("top", "bottom_left", "bottom_right")
"""Groups with a single color; their topics are those of the driver."""


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


_TOPICS: dict[type[Command], str] = {
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


def _led_row(group: str) -> CommandRow:
    """Return the row of a group of lights: a color for those of the body, intensities for all others."""
    if group in BODY_LEDS:
        return CommandRow(
            led_topic(group),
            ColorRGBA,
            partial(codecs.decode_color, group=group),
            codecs.encode_color,
            qos.LEDS,
            about="0…1; alpha is ignored",
            limit_check=saturation.color,
            is_retained=True,
        )
    return CommandRow(
        led_topic(group),
        Float32MultiArray,
        partial(codecs.decode_levels, group=group),
        codecs.encode_levels,
        qos.LEDS,
        about=f"{commands.LED_GROUPS[group]} intensities 0…1; empty: firmware behavior",
        limit_check=saturation.intensities,
        is_retained=True,
    )


def _gesture_row(name: str) -> CommandRow:
    return CommandRow(
        f"_led/gesture/{name}",
        Float32,
        partial(codecs.decode_gesture, name=name),
        profile=qos.LEDS,
        about="period in s, its sign the direction",
    )


ROWS = (
    CommandRow(
        "_motor/target",
        Int16MultiArray,
        codecs.decode_targets,
        codecs.encode_targets,
        about="left, right in Thymio units, ±500; valid until the next command",
        limit_check=saturation.targets,
        is_retained=True,
    ),
    *map(_led_row, commands.LED_GROUPS),
    CommandRow(
        "_led/single",
        Int16MultiArray,
        codecs.decode_single,
        codecs.encode_single,
        qos.LEDS,
        about="number of the light 0…39 (15 is none), brightness 0…32",
        limit_check=saturation.single,
        is_retained=True,
    ),
    CommandRow(
        "_led/own",
        Float32MultiArray,
        codecs.decode_own,
        codecs.encode_own,
        qos.LEDS,
        about="firmware behavior of a group; its name is layout.dim[0].label",
        limit_check=saturation.intensities,
        is_retained=True,
    ),
    *map(_gesture_row, ("circle", "blink", "kit")),
    CommandRow(
        "_led/gesture/alive",
        Empty,
        codecs.decode_alive,
        profile=qos.LEDS,
        about="the slow gesture that shows that the robot is on",
    ),
    CommandRow(
        "_led/gesture/off",
        Empty,
        codecs.decode_still,
        profile=qos.LEDS,
        about="stop the gesture; lights return to firmware behavior",
    ),
    CommandRow(
        "sound/tone",
        Float32MultiArray,
        codecs.decode_tone,
        codecs.encode_tone,
        qos.EVENTS,
        about="Hz, s; 0 s until stopped, a negative time stops",
        limit_check=saturation.tone,
    ),
    CommandRow(
        "_sound/system",
        Int8,
        codecs.decode_system,
        codecs.encode_system,
        qos.EVENTS,
        about="the robot's sound 0…7, -1 stops",
        limit_check=saturation.system_sound,
    ),
    CommandRow(
        "_sound/samples",
        UInt8MultiArray,
        codecs.decode_samples,
        codecs.encode_samples,
        qos.EVENTS,
        about="unsigned 8 bit at 7812.5 Hz, at most ten minutes",
    ),
    CommandRow(
        "_sound/wave",
        Int8MultiArray,
        codecs.decode_wave,
        codecs.encode_wave,
        qos.EVENTS,
        about="the period that tones are made of, 142 samples",
        is_retained=True,
    ),
    CommandRow(
        "_sound/volume",
        Int8,
        codecs.decode_volume,
        codecs.encode_volume,
        qos.EVENTS,
        about="bits that samples lose: 0 is loudest, 8 is off",
        is_retained=True,
    ),
    CommandRow(
        "_sound_threshold",
        Float32,
        codecs.decode_threshold,
        codecs.encode_threshold,
        about="0…1 of 255: louder sounds are published on `_sound`; 0 is off",
        limit_check=saturation.threshold,
        is_retained=True,
    ),
    CommandRow(
        "_comm/enable",
        Bool,
        codecs.decode_enable,
        codecs.encode_enable,
        about="infrared communication on or off",
        is_retained=True,
    ),
    CommandRow(
        "_comm/tx",
        Int16,
        codecs.decode_payload,
        codecs.encode_payload,
        about="the value that is sent, 0…2047",
        limit_check=saturation.payload,
        is_retained=True,
    ),
    CommandRow(
        "_alarm", Bool, codecs.decode_alarm, about="true: play the sound of an arrow button every three seconds"
    ),
    CommandRow("pen/down", Bool, codecs.decode_pen_down, about="true: the pen draws"),
    CommandRow(
        "_pen/color", ColorRGBA, codecs.decode_pen_color, about="0…1; alpha 0 erases", limit_check=saturation.paint
    ),
    CommandRow("_pen/width", Float32, codecs.decode_pen_width, about="m, 0.001…0.1"),
)
"""Every topic that carries commands one to one; robot_inputs adds those that need more than the message."""
