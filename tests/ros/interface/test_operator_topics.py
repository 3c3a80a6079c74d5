"""What an operator does, from message to command."""

from __future__ import annotations

import pytest
from std_msgs.msg import Bool, Empty, Float32, Float32MultiArray, Int8, Int16MultiArray

from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.operator_topics import ROWS
from thymio_sim_ros.sim.commands import (
    Clap,
    ConnectCharger,
    Lift,
    RemoteKey,
    SetAmbientLight,
    SetBattery,
    SetGround,
    SetNoiseLevel,
    SetProximity,
    SetTemperature,
    Tap,
    Tilt,
)

BY_TOPIC = {row.topic: row for row in ROWS}


def decode(topic, message):
    assert isinstance(message, BY_TOPIC[topic].type)
    return BY_TOPIC[topic].decode(message)


@pytest.mark.parametrize(
    ("topic", "message", "command"),
    [
        ("_press/tap", Empty(), Tap()),
        ("_press/clap", Float32(data=1.0), Clap(255)),
        ("_press/clap", Float32(data=-3.0), Clap(0)),
        ("_press/sound", Float32(data=0.5), SetNoiseLevel(128)),
        ("_press/sound", Float32(data=7.0), SetNoiseLevel(255)),
        ("_press/remote", Int8(data=80), RemoteKey(0, 80)),
        ("_press/rc5", Int16MultiArray(data=[31, 127]), RemoteKey(31, 127)),
        ("_press/tilt", Float32MultiArray(data=[0.5, -0.25]), Tilt(0.5, -0.25)),
        ("_press/lift", Bool(data=True), Lift(True)),
        ("_press/light", Float32(data=0.5), SetAmbientLight(512)),
        ("_press/light", Float32(data=2.0), SetAmbientLight(1023)),
        (
            "_press/proximity",
            Int16MultiArray(data=[4505, 0, -1, -1, -1, -1, -1]),
            SetProximity((4505, 0, -1, -1, -1, -1, -1)),
        ),
        ("_press/proximity", Int16MultiArray(data=[]), SetProximity((-1,) * 7)),
        ("_press/ground", Int16MultiArray(data=[0, 1023]), SetGround((0, 1023))),
        ("_press/temperature", Float32(data=-10.5), SetTemperature(-10.5)),
        ("_press/battery", Float32(data=3.5), SetBattery(3.5)),
        ("_press/charger", Bool(data=True), ConnectCharger(True)),
    ],
)
def test_a_message_becomes_a_command(topic, message, command):
    assert decode(topic, message) == command


@pytest.mark.parametrize(
    ("topic", "message", "found"),
    [
        ("_press/clap", Float32(data=float("nan")), "loudness is nan"),
        ("_press/sound", Float32(data=float("inf")), "loudness is inf"),
        ("_press/light", Float32(data=float("nan")), "light is nan"),
        ("_press/remote", Int8(data=-1), "RemoteKey: command -1 found, expected 0 to 127"),
        ("_press/rc5", Int16MultiArray(data=[32, 0]), "RemoteKey: address 32 found"),
        ("_press/rc5", Int16MultiArray(data=[1]), r"found 1 values, expected \[address"),
        ("_press/tilt", Float32MultiArray(data=[1.0]), r"found 1 values, expected \[roll, pitch\]"),
        ("_press/tilt", Float32MultiArray(data=[float("nan"), 0.0]), "Tilt: roll_rad nan"),
        ("_press/proximity", Int16MultiArray(data=[1]), "SetProximity: 1 counts found, expected 7"),
        (
            "_press/ground",
            Int16MultiArray(data=[0, 1024]),
            r"SetGround: counts\[1\] 1024 found, expected 0 to 1023, or -1",
        ),
        ("_press/temperature", Float32(data=100.0), "SetTemperature: celsius 100"),
        ("_press/battery", Float32(data=float("nan")), "SetBattery: volts nan"),
    ],
)
def test_invalid_messages_are_rejected(topic, message, found):
    with pytest.raises(CommandError, match=found):
        decode(topic, message)
