"""Values beyond a limit of the robot are clamped, logged once per topic, and counted in the diagnostics."""

from __future__ import annotations

import functools
import itertools
import math

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from rcl_interfaces.msg import Log
from rclpy.serialization import deserialize_message, serialize_message
from std_msgs.msg import (
    Bool,
    ColorRGBA,
    Empty,
    Float32,
    Float32MultiArray,
    Float64MultiArray,
    Int8,
    Int8MultiArray,
    Int16,
    Int16MultiArray,
    UInt8MultiArray,
)

from tests.ros.test_every_topic import SENT
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_codecs import MAX_SAMPLES
from thymio_sim_ros.ros.interface.robot_inputs import WORLD, InputContext, robot_inputs
from thymio_sim_ros.sim.audio.synthesis import HIGHEST_HZ, LOWEST_HZ
from thymio_sim_ros.sim.commands import LED_GROUPS
from thymio_sim_ros.sim.model.robot_constants import MAX_SPEED_M_S, WHEEL_RADIUS_M

INPUTS = {one.topic: one for one in robot_inputs()}
FULL_RAD_S = MAX_SPEED_M_S / WHEEL_RADIUS_M


def twist(linear, angular=0.0):
    return Twist(linear=Vector3(x=linear), angular=Vector3(z=angular))


BEYOND = {
    "cmd_vel": (
        twist(0.5),
        twist(MAX_SPEED_M_S),
        "a wheel would need 0.5 m/s, expected at most 0.166; both wheels are slowed down together",
    ),
    "cmd_vel_stamped": (TwistStamped(twist=twist(0.0, 10.0)), TwistStamped(twist=twist(0.1, -1.0)), "a wheel would"),
    "_wheels/command": (
        Float64MultiArray(data=[0.0, -20.0]),
        Float64MultiArray(data=[FULL_RAD_S, -FULL_RAD_S]),
        "a wheel would need 0.44 m/s",
    ),
    "_motor/target": (
        Int16MultiArray(data=[0, -501]),
        Int16MultiArray(data=[500, -500]),
        "found target -501, expected -500 to 500",
    ),
    **{
        f"led/body/{group}": (ColorRGBA(r=255.0), ColorRGBA(r=1.0, a=255.0), "found color 255, expected 0 to 1")
        for group in ("top", "bottom_left", "bottom_right")
    },
    **{
        topic: (
            Float32MultiArray(data=[0.0] * (size - 1) + [32.0]),
            Float32MultiArray(data=[1.0] * size),
            "found intensity 32, expected 0 to 1",
        )
        for group, size in LED_GROUPS.items()
        for topic in (f"led/{group}", f"_led/{group}")
        if topic in INPUTS and group not in ("top", "bottom_left", "bottom_right")
    },
    "_led/single": (Int16MultiArray(data=[3, 33]), Int16MultiArray(data=[38, 32]), "found brightness 33"),
    "sound/tone": (
        Float32MultiArray(data=[9000.0, 1.0]),
        Float32MultiArray(data=[0.0, -1.0]),
        "found frequency 9000, expected 55.0",
    ),
    "_sound/system": (Int8(data=8), Int8(data=-1), "found sound 8, expected -1 to 7; the robot beeps instead"),
    "_sound_threshold": (
        Float32(data=-0.5),
        Float32(data=1.0),
        "found threshold -0.5, expected 0 to 1 (0 is off); every sound is published with this value",
    ),
    "_comm/tx": (Int16(data=2048), Int16(data=0), "found value 2048, expected 0 to 2047"),
    "_pen/color": (ColorRGBA(g=-1.0, a=1.0), ColorRGBA(), "found color -1"),
    "_press/clap": (Float32(data=1.5), Float32(data=1.0), "found loudness 1.5, expected 0 to 1"),
    "_press/sound": (Float32(data=-0.5), Float32(data=0.0), "found loudness -0.5"),
    "_press/light": (Float32(data=2.0), Float32(data=1.0), "found light 2"),
}
"""A message beyond the limits, one just within, and the description of the first."""


@pytest.mark.parametrize("topic", BEYOND)
def test_values_beyond_a_limit_are_described(topic):
    one, (message, within, said) = INPUTS[topic], BEYOND[topic]
    assert one.limit_check(message).startswith(said)
    assert one.limit_check(within) == ""


NOW = InputContext(0, 0, lambda: {"map": WORLD})
NOTHING_TO_REFUSE = {"_sound/samples": "any bytes are a sound", "_sound/wave": "any bytes are a wave"}
"""Topics of which each number that their type holds is meant as it is."""
ENDLESS = [math.nan, math.inf, -math.inf]
FAR = [-1e30, 1e30]
INTEGERS = {Int8: [-0x80, 0x7F], Int16: [-0x8000, 0x7FFF], Int16MultiArray: [-0x8000, 0x7FFF]}
ARRAYS = (Float32MultiArray, Float64MultiArray, Int16MultiArray, Int8MultiArray)
OWN = [one for one in INPUTS.values() if not one.topic.startswith("actuator/")]


def changed(message, place, value):
    """A copy with one number replaced: `place` is a path of fields, or a number in an array."""
    copy = deserialize_message(serialize_message(message), type(message))
    if isinstance(place, int):
        copy.data[place] = value
        return copy
    *path, last = place.split(".")
    setattr(functools.reduce(getattr, path, copy), last, value)
    return copy


def bad_messages(one):
    """Messages of this input that mean nothing on a robot, made from a good one: too far, not finite, too many."""
    good = GOOD[one.topic]
    kind = one.type
    if kind in (Bool, Empty) or one.topic in NOTHING_TO_REFUSE:
        places, values = [], []
    elif kind in ARRAYS:
        places = range(len(good.data))
        values = INTEGERS.get(kind, [*FAR, *ENDLESS])
    elif kind in INTEGERS:
        meant = (0x7F,) if one.topic.endswith("press/remote") else ()
        places, values = ["data"], [value for value in INTEGERS[kind] if value not in meant]
    elif kind is Float32:
        places, values = ["data"], [*FAR, *ENDLESS]
    elif kind is ColorRGBA:
        places, values = ["r", "g", "b"] + ["a"] * (one.topic == "_pen/color"), [*FAR, *ENDLESS]
    else:
        before = {Twist: "", TwistStamped: "twist."}.get(kind)
        places = [f"{before}linear.x", f"{before}angular.z"] if before is not None else [
            f"pose.pose.{field}" for field in ("position.x", "position.y", "orientation.z", "orientation.w")
        ]  # fmt: skip
        values = [*FAR, *ENDLESS] if before is not None else ENDLESS
    for place, value in itertools.product(places, values):
        yield changed(good, place, value)
    if kind in ARRAYS:
        for size in {len(good.data) + 1, len(good.data) - 1, 0} - EMPTY_MEANS.get(one.topic, set()):
            copy = changed(good, 0, good.data[0]) if len(good.data) else kind()
            copy.data = [*good.data, *good.data[-1:]][:size]
            yield copy
    if one.topic == "_sound/samples":
        yield UInt8MultiArray(data=bytes(MAX_SAMPLES + 1))


EMPTY_MEANS = {topic: {0} for topic in INPUTS if topic.endswith(("press/proximity", "press/ground"))} | {
    topic: {0} for topic in INPUTS if topic.startswith(("led/", "_led/")) and INPUTS[topic].type is Float32MultiArray
}
"""Where an array of nothing gives something back to the robot."""
EMPTY_MEANS["_led/own"] = set()
GOOD = {topic: message for topic, (message, _) in SENT.items()}


def answer(one, message):
    """Return the report about a message: the reason of a rejection, the clamped value, or nothing."""
    try:
        commands = one.commands(message, NOW)
    except CommandError as error:
        return str(error)
    assert commands, one.topic
    return one.limit_check(message)


@pytest.mark.parametrize("one", OWN, ids=[one.topic for one in OWN])
def test_every_value_beyond_a_limit_is_described(one):
    silent = [message for message in bad_messages(one) if not answer(one, message)]
    # a tone of negative length is how a sound is stopped
    silent = [message for message in silent if one.topic != "sound/tone" or message.data[1] >= 0.0]
    assert silent == []


@pytest.mark.parametrize("one", OWN, ids=[one.topic for one in OWN])
def test_a_message_within_the_limits_is_not_reported(one):
    assert answer(one, GOOD[one.topic]) == ""


def test_every_input_but_switches_is_tried_with_bad_messages():
    untried = [one.topic for one in OWN if not list(bad_messages(one))]
    assert {INPUTS[topic].type for topic in untried} <= {Bool, Empty}


@pytest.mark.parametrize("number", [-1, 15, 40])
def test_a_light_that_there_is_not_is_refused(number):
    with pytest.raises(CommandError, match=f"found light {number}, expected 0 to 39, but for 15"):
        INPUTS["_led/single"].commands(Int16MultiArray(data=[number, 5]), NOW)


@pytest.mark.parametrize("hertz", [LOWEST_HZ, -LOWEST_HZ, HIGHEST_HZ, -HIGHEST_HZ])
@pytest.mark.parametrize("seconds", [0.0, 1.0])
def test_tones_are_limited_to_what_the_wave_can_have_either_sign_and_however_long(hertz, seconds):
    def limit_check(factor):
        return INPUTS["sound/tone"].limit_check(Float32MultiArray(data=[factor * hertz, seconds]))

    outwards = 1.01 if abs(hertz) == HIGHEST_HZ else 0.99
    assert limit_check(1.0) == limit_check(1 / outwards) == ""
    assert limit_check(outwards).startswith("found frequency")


def test_a_command_beyond_a_limit_is_clamped_logged_once_and_counted(ros, simulation):
    sim = simulation()
    logs = ros.collect(Log, "/rosout", where=lambda log: "clamped" in log.msg)
    diagnostics = ros.collect(DiagnosticArray, "/diagnostics")
    wheels = ros.publisher(Twist, "/cmd_vel")
    for _ in range(2):
        wheels.publish(twist(0.5))
        sim.step(0.2)
    ros.publisher(ColorRGBA, "/led/body/top").publish(ColorRGBA(r=255.0))
    ros.until(lambda: len(logs) == 2)
    assert [log.msg.partition(":")[0] for log in logs] == ["/cmd_vel clamped", "/led/body/top clamped"]
    assert sim.thymio.speed == pytest.approx(MAX_SPEED_M_S, rel=0.1)
    sim.simulator._publish_heartbeat(0)
    ros.until(lambda: diagnostics)
    assert {pair.key: pair.value for pair in diagnostics[-1].status[1].values}["clamped"] == "3"
