"""Topics of the driver: those hidden here, and those of thymio_msgs (types of the same fields where it is missing)."""

from __future__ import annotations

import dataclasses
import math
from types import SimpleNamespace
from typing import Any

import pytest
from builtin_interfaces.msg import Duration
from sensor_msgs.msg import Temperature
from std_msgs.msg import ColorRGBA, Empty

from thymio_sim_ros.ros import generate_ros_docs
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.driver_topics import STANDARD_TOPICS, TOPICS, of
from thymio_sim_ros.ros.interface.robot_inputs import InputContext
from thymio_sim_ros.sim.commands import (
    LED_GROUPS,
    PlayGesture,
    PlaySystemSound,
    PlayTone,
    SetLeds,
    StopGesture,
    StopSound,
)
from thymio_sim_ros.sim.model.readings import CommReading

NOW = InputContext(0, 0)


def kind(name, constants=None, **fields):
    members = [(field, Any, dataclasses.field(default_factory=make)) for field, make in fields.items()]
    return dataclasses.make_dataclass(name, members, namespace=dict(constants or {}))


def types():
    try:
        import thymio_msgs.msg
    except ImportError:
        return SimpleNamespace(
            Comm=kind("Comm", value=int, payloads=list, intensities=list),
            Led=kind("Led", id=int, values=list),
            LedGesture=kind(
                "LedGesture",
                {"OFF": 0, "WAVE": 1, "RECT": 0, "HARMONIC": 1},
                gesture=int, wave=int, leds=int, period=float, length=int, mirror=int, mask=list,
            ),
            Sound=kind("Sound", duration=Duration, frequency=float),
            SystemSound=kind("SystemSound", {"STOP": -1}, sound=int),
        )  # fmt: skip
    return thymio_msgs.msg


TYPES = types()
DRIVER = of(TYPES)
INPUTS = {one.topic: one for one in DRIVER.inputs}


def wave(leds=0, shape=1, period=2.0, length=8):
    return TYPES.LedGesture(gesture=1, leds=leds, wave=shape, period=period, length=length)


def taken(topic, message):
    (command,) = INPUTS[topic].commands(message, NOW)
    return command


def test_every_topic_of_the_page_is_there():
    assert {*INPUTS, *(row.topic for rows in DRIVER.rows.values() for row in rows)} == set(TOPICS)


@pytest.mark.parametrize(
    ("topic", "message", "command"),
    [
        ("led", TYPES.Led(id=0, values=[1.0] * 8), SetLeds("circle", (32,) * 8)),
        ("led", TYPES.Led(id=6, values=[0.5]), SetLeds("remote", (16,))),
        ("led", TYPES.Led(id=3, values=[1.0, 0.0, 1.0, 1.0]), SetLeds("ground", (32, 0))),
        ("led/gesture", TYPES.LedGesture(), StopGesture()),
        ("led/gesture", wave(), PlayGesture("circle", 2.0)),
        ("led/gesture", wave(period=-0.5, length=1), PlayGesture("blink", -0.5)),
        ("led/gesture", wave(shape=0, period=3.0, length=24), PlayGesture("alive", 3.0)),
        ("led/gesture", wave(leds=1, length=12), PlayGesture("kit", 2.0)),
        ("sound/play", TYPES.Sound(duration=Duration(sec=1, nanosec=5), frequency=440.0), PlayTone(440.0, 10**9 + 5)),
        ("sound/play", TYPES.Sound(frequency=0.0), PlayTone(1.0, 10**9 // 60)),
        ("sound/play/system", TYPES.SystemSound(sound=-1), StopSound()),
        ("sound/play/system", TYPES.SystemSound(sound=3), PlaySystemSound(3)),
    ],
)
def test_what_a_message_commands(topic, message, command):
    assert taken(topic, message) == command


@pytest.mark.parametrize("number", range(7))
def test_every_group_of_lights_has_a_number(number):
    group = taken("led", TYPES.Led(id=number, values=[0.0] * 8)).group
    assert group == ("circle", "proximity", "buttons", "ground", "temperature", "microphone", "remote")[number]
    assert group in LED_GROUPS


@pytest.mark.parametrize(
    ("topic", "message", "found"),
    [
        ("led", TYPES.Led(id=7, values=[1.0] * 8), "found group 7, expected 0 to 6: circle"),
        ("led", TYPES.Led(id=0, values=[1.0]), "found 1 values, expected 8 intensities"),
        ("led", TYPES.Led(id=5, values=[math.nan]), "intensity is nan"),
        ("led/gesture", wave(leds=2), "found a gesture of the buttons lights"),
        ("led/gesture", wave(period=math.nan), "period is nan"),
        ("led/gesture", wave(period=0.0), "period 0 s found"),
        ("sound/play", TYPES.Sound(frequency=math.inf), "frequency is inf"),
    ],
)
def test_invalid_messages_are_rejected(topic, message, found):
    with pytest.raises(CommandError, match=found):
        taken(topic, message)


def test_lights_beyond_full_brightness_are_reported():
    assert INPUTS["led"].limit_check(TYPES.Led(id=5, values=[32.0])) == "found intensity 32, expected 0 to 1"
    assert INPUTS["led"].limit_check(TYPES.Led(id=5, values=[1.0, 32.0])) == ""


def test_an_infrared_frame_is_published_with_payloads_and_intensities():
    (row,) = DRIVER.rows["comm"]
    message = row.encode(CommReading(0, (7, *range(7), *range(100, 107))), None, None)
    assert message.value == 7
    assert list(message.payloads) == [0, 1, 2, 3, 4, 5, 6]
    assert list(message.intensities) == [100, 101, 102, 103, 104, 105, 106]


def test_without_the_package_there_are_no_topics_of_its_types(ros, simulation):
    simulation(driver_topics=True)
    installed = hasattr(TYPES.Led, "get_fields_and_field_types")
    there = {topic for topic, _ in ros.node.get_topic_names_and_types()}
    assert {f"/{topic}" in there for topic in TOPICS} == {installed}


def test_without_the_parameter_the_driver_s_rare_names_are_not_there(ros, simulation):
    simulation()
    there = {topic for topic, _ in ros.node.get_topic_names_and_types()}
    assert there & {f"/{topic}" for topic in (*STANDARD_TOPICS, *TOPICS)} == set()
    assert {f"/_{topic}" for topic in STANDARD_TOPICS} <= there


def test_with_the_parameter_each_hidden_topic_has_the_driver_s_name_too(ros, simulation):
    simulation(playground="two_robots", driver_topics=True)
    there = dict(ros.node.get_topic_names_and_types())
    for robot in ("red", "blue"):
        assert {topic: there.get(f"/{robot}/{topic}") for topic in STANDARD_TOPICS} == {
            topic: there[f"/{robot}/_{topic}"] for topic in STANDARD_TOPICS
        }


def test_messages_on_the_driver_s_names_act_and_are_sent(ros, simulation):
    sim = simulation(driver_topics=True)
    warm, taps = ros.collect(Temperature, "/temperature"), ros.collect(Empty, "/tap")
    ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=1.0))
    sim.until(lambda: dict(sim.world.snapshot().robots[0].leds)["top"] == (32, 0, 0), seconds=1)
    ros.publisher(Empty, "/led/off").publish(Empty())
    sim.until(lambda: dict(sim.world.snapshot().robots[0].leds)["top"] == (0, 0, 0), seconds=1)
    ros.publisher(Empty, "/_press/tap").publish(Empty())
    sim.until(lambda: warm and taps, seconds=2)


def test_with_the_package_a_message_acts_over_ros(ros, simulation):
    messages = pytest.importorskip("thymio_msgs.msg", reason="no wheel has thymio_msgs")
    sim = simulation(driver_topics=True)
    assert generate_ros_docs.type_name(messages.Led) == "thymio_msgs/msg/Led"
    ros.publisher(messages.Led, "/led").publish(messages.Led(id=0, values=[1.0] * 8))
    sim.until(lambda: sim.world.snapshot().robots[0].leds[3] == ("circle", (32,) * 8), seconds=1)
