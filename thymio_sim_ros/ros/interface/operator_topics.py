"""Topics `_press/…` for stimuli by an operator, one row each; programs do not publish on them.

Names: docs/spec/ros-interface.md section 4.2; those beyond it follow their pattern.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, TypeVar

from std_msgs.msg import Bool, Empty, Float32, Float32MultiArray, Int8, Int16MultiArray

from thymio_sim_ros.ros.interface import command_checks, qos, saturation
from thymio_sim_ros.ros.interface.command_checks import CommandError
from thymio_sim_ros.ros.interface.command_row import CommandRow
from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.units import GROUND_FULL

__all__ = ["ROWS"]

C = TypeVar("C", bound=Command)
P = ParamSpec("P")


def _checked(make: Callable[P, C], *values: P.args, **named: P.kwargs) -> C:
    """Create a command. Raises CommandError for values out of range."""
    try:
        return make(*values, **named)
    except ValueError as error:
        raise CommandError(str(error)) from error


def _level(message: Float32) -> int:
    command_checks.finite(message.data, "loudness")
    return round(min(max(float(message.data), 0.0), 1.0) * FULL_LEVEL)


def _tap(_message: Empty) -> Command:
    return commands.Tap()


def _remote(message: Int8) -> Command:
    return _checked(commands.RemoteKey, 0, int(message.data))


def _rc5(message: Int16MultiArray) -> Command:
    address, command = command_checks.sized(message.data, 2, "[address 0…31, command 0…127]")
    return _checked(commands.RemoteKey, int(address), int(command))


def _tilt(message: Float32MultiArray) -> Command:
    roll, pitch = command_checks.sized(message.data, 2, "[roll, pitch] in rad")
    return _checked(commands.Tilt, float(roll), float(pitch))


def _light(message: Float32) -> Command:
    command_checks.finite(message.data, "light")
    return commands.SetAmbientLight(round(min(max(float(message.data), 0.0), 1.0) * GROUND_FULL))


def _proximity(message: Int16MultiArray) -> Command:
    return _checked(commands.SetProximity, tuple(message.data) or (-1,) * 7)


def _ground(message: Int16MultiArray) -> Command:
    return _checked(commands.SetGround, tuple(message.data) or (-1,) * 2)


def _temperature(message: Float32) -> Command:
    return _checked(commands.SetTemperature, float(message.data))


def _battery(message: Float32) -> Command:
    return _checked(commands.SetBattery, float(message.data))


def _charger(message: Bool) -> Command:
    return commands.ConnectCharger(bool(message.data))


ROWS = (
    CommandRow("_press/tap", Empty, _tap, profile=qos.EVENTS, about="a knock on the body"),
    CommandRow(
        "_press/clap",
        Float32,
        lambda message: commands.Clap(_level(message)),
        profile=qos.EVENTS,
        about="a clap beside the robot, 0…1; other robots hear it depending on their distance",
        limit_check=saturation.loudness,
    ),
    CommandRow(
        "_press/sound",
        Float32,
        lambda message: commands.SetNoiseLevel(_level(message)),
        profile=qos.EVENTS,
        about="steady noise around the robot, 0…1",
        limit_check=saturation.loudness,
    ),
    CommandRow("_press/remote", Int8, _remote, profile=qos.EVENTS, about="a key of a remote control, 0…127"),
    CommandRow(
        "_press/rc5", Int16MultiArray, _rc5, profile=qos.EVENTS, about="address 0…31, command 0…127 of a remote control"
    ),
    CommandRow(
        "_press/tilt",
        Float32MultiArray,
        _tilt,
        profile=qos.EVENTS,
        about="roll, pitch in rad: hold the robot at this angle until the next message",
    ),
    CommandRow(
        "_press/lift",
        Bool,
        lambda message: commands.Lift(bool(message.data)),
        profile=qos.EVENTS,
        about="whether the robot is held over the floor; put down, it stands where it is",
    ),
    CommandRow(
        "_press/light",
        Float32,
        _light,
        profile=qos.EVENTS,
        about="ambient light on the ground, 0…1",
        limit_check=saturation.light,
    ),
    CommandRow(
        "_press/proximity",
        Int16MultiArray,
        _proximity,
        profile=qos.EVENTS,
        about="override of the seven sensor counts, 0…4505; -1: simulated value; empty: all simulated",
    ),
    CommandRow(
        "_press/ground",
        Int16MultiArray,
        _ground,
        profile=qos.EVENTS,
        about="override of the two ground sensor counts, 0…1023; -1: simulated value; empty: both simulated",
    ),
    CommandRow("_press/temperature", Float32, _temperature, profile=qos.EVENTS, about="°C around the robot, -40…85"),
    CommandRow("_press/battery", Float32, _battery, profile=qos.EVENTS, about="V of the battery, 0…5"),
    CommandRow("_press/charger", Bool, _charger, profile=qos.EVENTS, about="whether the charger is connected"),
)
"""Loudness is 0…1 of 255, light of 1023, both clamped; temperature in °C, battery in V, rejected if out of range."""
