"""Additional topics for code that was written for the Thymio's ROS driver (parameter `driver_topics`).

Some topics of the driver have hidden names here; with the parameter they also exist under the driver's names. Topics
with types of the driver's package `thymio_msgs` exist if that package is installed; each has an equivalent with a
standard type (docs/spec/ros-interface.md section 4).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Protocol, TypeVar

from builtin_interfaces.msg import Duration
from rclpy.node import Node
from rclpy.qos import QoSProfile

from thymio_sim_ros.ros.interface import command_checks, qos, saturation, sensor_topics
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.extra_topics import ExtraTopics
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.interface.names import HIDDEN
from thymio_sim_ros.ros.interface.robot_inputs import InputContext, RobotInput, robot_inputs
from thymio_sim_ros.ros.interface.saturation import LimitCheck
from thymio_sim_ros.ros.interface.sensor_topics import Row
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["PACKAGE", "STANDARD_TOPICS", "TOPICS", "driver_name", "found", "of", "plain"]

PACKAGE = "thymio_msgs"

GROUPS = ("circle", "proximity", "buttons", "ground", "temperature", "microphone", "remote")
"""Groups of lights by the number in `Led` and `LedGesture`."""

MIN_TONE_NS = SECOND_NS // 60
"""Shortest duration of a tone, as in the driver."""

STANDARD_TOPICS = (
    "alarm",
    "buttons",
    "comm/enable",
    "comm/received",
    "comm/tx",
    "led/gesture/alive",
    "led/gesture/blink",
    "led/gesture/circle",
    "led/gesture/kit",
    "led/gesture/off",
    "led/off",
    "proximity/laser",
    "remote",
    "sound",
    "sound_threshold",
    "tap",
    "temperature",
)
"""The driver's topics with standard types that have hidden names here: `_alarm` and so on."""

TOPICS: Mapping[str, tuple[str, str, str]] = {
    "comm/rx": ("out", "Comm", "an infrared frame: value, payloads and intensities of the seven sensors"),
    "led": (
        "in",
        "Led",
        "group 0…6 (circle, proximity, buttons, ground, temperature, microphone, remote), intensities",
    ),
    "led/gesture": ("in", "LedGesture", "the nearest of `_led/gesture/{circle,blink,kit,alive,off}`"),
    "sound/play": ("in", "Sound", "Hz, duration of at least 1/60 s"),
    "sound/play/system": ("in", "SystemSound", "the robot's sound 0…7, -1 stops"),
}
"""Direction, type and meaning of the topics with types of `thymio_msgs`."""


# The messages of thymio_msgs, as far as they are read here.


class _Led(Protocol):
    id: int
    values: Sequence[float]


class _LedGesture(Protocol):
    gesture: int
    leds: int
    wave: int
    period: float
    length: int
    OFF: int
    RECT: int


class _Sound(Protocol):
    frequency: float
    duration: Duration


class _SystemSound(Protocol):
    sound: int
    STOP: int


def plain() -> ExtraTopics:
    """Return the topics with standard types, under the driver's names."""
    rows = {sensor.name: _plain(sensor_topics.rows_of(sensor)) for sensor in all_sensors()}
    return ExtraTopics({sensor: named for sensor, named in rows.items() if named}, _plain(robot_inputs()))


def of(messages: Any) -> ExtraTopics:
    """Return the topics with types of the module `thymio_msgs.msg`."""

    def comm(reading: Reading, _names: object, _options: object) -> Any:
        words = reading.words
        return messages.Comm(value=words[0], payloads=words[1:8], intensities=words[8:15])

    def taken(topic: str, act: Any, profile: QoSProfile, limit_check: LimitCheck = saturation.nothing) -> RobotInput:
        _, kind, about = TOPICS[topic]
        return RobotInput(topic, getattr(messages, kind), act, about, profile, limit_check)

    return ExtraTopics(
        {"comm": (Row("comm/rx", messages.Comm, comm, TOPICS["comm/rx"][2]),)},
        (
            taken("led", _led, qos.LEDS, _too_bright),
            taken("led/gesture", _gesture, qos.LEDS),
            taken("sound/play", _tone, qos.EVENTS, lambda message: saturation.frequency(message.frequency)),
            taken("sound/play/system", _system, qos.EVENTS, lambda message: saturation.sound_number(message.sound)),
        ),
    )


def driver_name(topic: str) -> str:
    """Return the driver's name of a topic."""
    plain = topic.removeprefix(HIDDEN)
    return plain if plain in STANDARD_TOPICS else topic


def found(node: Node) -> ExtraTopics:
    """Return all topics that are available; a package that is installed but cannot be imported is logged."""
    try:
        import thymio_msgs.msg
    except ImportError as error:
        if not isinstance(error, ModuleNotFoundError) or error.name != PACKAGE:
            node.get_logger().warning(f"{PACKAGE} is left out: {error}")
        return plain()
    return plain().with_all(of(thymio_msgs.msg))


_R = TypeVar("_R", Row, RobotInput)


def _plain(rows: Iterable[_R]) -> tuple[_R, ...]:
    """Return the rows that have another name in the driver, under that name."""
    return tuple(replace(row, topic=driver_name(row.topic)) for row in rows if driver_name(row.topic) != row.topic)


def _group(number: int) -> str:
    if number >= len(GROUPS):
        raise CommandError(f"found group {number}, expected 0 to {len(GROUPS) - 1}: {', '.join(GROUPS)}")
    return GROUPS[number]


def _led(message: _Led, _input_context: InputContext) -> Sequence[Command]:
    group = _group(message.id)
    size = commands.LED_GROUPS[group]
    return (command_checks.led_levels(group, list(message.values)[:size]),)


def _too_bright(message: _Led) -> str:
    return saturation.brightness(message.values[: commands.LED_GROUPS[GROUPS[message.id]]])


def _gesture(message: _LedGesture, _input_context: InputContext) -> Sequence[Command]:
    """Find the gesture of the driver by group, wave form and length."""
    if message.gesture == message.OFF:
        return (commands.StopGesture(),)
    group = _group(message.leds)
    if group == "circle":
        name = "alive" if message.wave == message.RECT else "blink" if message.length <= 1 else "circle"
    elif group == "proximity":
        name = "kit"
    else:
        raise CommandError(f"found a gesture of the {group} lights, expected circle (0) or proximity (1)")
    if not math.isfinite(message.period):
        raise CommandError(f"period is {message.period}, expected a finite number")
    try:
        return (commands.PlayGesture(name, float(message.period)),)
    except ValueError as error:
        raise CommandError(str(error)) from error


def _tone(message: _Sound, _input_context: InputContext) -> Sequence[Command]:
    command_checks.finite(message.frequency, "frequency")
    duration_ns = message.duration.sec * SECOND_NS + message.duration.nanosec
    return (commands.PlayTone(max(1.0, float(message.frequency)), max(MIN_TONE_NS, duration_ns)),)


def _system(message: _SystemSound, _input_context: InputContext) -> Sequence[Command]:
    return (commands.StopSound() if message.sound == message.STOP else commands.PlaySystemSound(int(message.sound)),)
