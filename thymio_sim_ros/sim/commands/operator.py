"""Commands of an operator: handling, sounds, light, battery, pen."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.commands._limits import check, check_counts

__all__ = [
    "BUTTONS",
    "Clap",
    "ConnectCharger",
    "DrawJumps",
    "Lift",
    "MoveObject",
    "MoveRobot",
    "Operating",
    "PressButton",
    "RemoteKey",
    "SetAmbientLight",
    "SetBattery",
    "SetGround",
    "SetNoiseLevel",
    "SetPen",
    "SetProximity",
    "SetTemperature",
    "Tap",
    "Tilt",
]

BUTTONS = ("backward", "left", "center", "forward", "right")
"""The five buttons, in the order of the firmware's variables (docs/spec/thymio-robot.md section 4)."""


@dataclass(frozen=True, slots=True)
class PressButton:
    """Press or release one of `BUTTONS`."""

    button: str
    pressed: bool


@dataclass(frozen=True, slots=True)
class MoveRobot:
    """Move the robot to a pose (m, rad, world frame); the odometry does not change."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class MoveObject:
    """Move an object to a pose, at rest (m, rad, world frame)."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class SetPen:
    """The pen in the pen hole, put in by an operator; None leaves a property as it is.

    `color`: red, green, blue 0…1; `width_m` 0.001…0.1; `erase`: it erases drawings instead.
    """

    down: bool | None = None
    color: tuple[float, float, float] | None = None
    width_m: float | None = None
    erase: bool | None = None


@dataclass(frozen=True, slots=True)
class DrawJumps:
    """Whether the pen draws a line to where a hand moves the robot; otherwise a stroke ends there."""

    is_on: bool


@dataclass(frozen=True, slots=True)
class Tap:
    """Tap the body of the robot."""


@dataclass(frozen=True, slots=True)
class Tilt:
    """Hold the robot at an angle in rad, ±pi, until the next command; roll lifts its left side, pitch lowers its front.

    Raises ValueError for a value out of range.
    """

    roll_rad: float
    pitch_rad: float

    def __post_init__(self) -> None:
        check(self, -math.pi, math.pi, "roll_rad", "pitch_rad")


@dataclass(frozen=True, slots=True)
class Lift:
    """Lift the robot off the floor, or put it down where it is.

    While it is lifted its wheels turn in the air, and it neither meets nor sees anything; it can be moved.
    """

    is_lifted: bool


@dataclass(frozen=True, slots=True)
class Clap:
    """A clap beside the robot, in units of mic.intensity, 0…255; other robots hear it attenuated by distance.

    Raises ValueError for a value out of range.
    """

    intensity: int

    def __post_init__(self) -> None:
        check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetNoiseLevel:
    """A continuous noise for this robot only, in units of mic.intensity, 0…255.

    Raises ValueError for a value out of range.
    """

    intensity: int

    def __post_init__(self) -> None:
        check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetAmbientLight:
    """Light that reaches the ground sensors besides their own, in units of prox.ground.ambiant, 0…1023.

    Raises ValueError for a value out of range.
    """

    level: int

    def __post_init__(self) -> None:
        check(self, 0, 1023, "level")


@dataclass(frozen=True, slots=True)
class SetProximity:
    """Override the counts of the seven proximity sensors, 0…4505 in Thymio's order; -1: measured.

    Raises ValueError for a value out of range.
    """

    counts: tuple[int, ...]

    def __post_init__(self) -> None:
        check_counts(self, self.counts, 7, 4505)


@dataclass(frozen=True, slots=True)
class SetGround:
    """Override the counts of the two ground sensors, without ambient light, 0…1023; -1: measured.

    Raises ValueError for a value out of range.
    """

    counts: tuple[int, ...]

    def __post_init__(self) -> None:
        check_counts(self, self.counts, 2, 1023)


@dataclass(frozen=True, slots=True)
class SetTemperature:
    """Temperature around the robot in °C, -40…85.

    Raises ValueError for a value out of range.
    """

    celsius: float

    def __post_init__(self) -> None:
        check(self, -40.0, 85.0, "celsius")


@dataclass(frozen=True, slots=True)
class RemoteKey:
    """A frame of an RC5 remote control: address 0…31, command 0…127.

    A frame that repeats address, command and toggle bit of the one before is the same key still held, and ignored.
    Without a `toggle`, it is a new press. Raises ValueError for a value out of range.
    """

    address: int
    command: int
    toggle: bool | None = None

    def __post_init__(self) -> None:
        check(self, 0, 31, "address")
        check(self, 0, 127, "command")


@dataclass(frozen=True, slots=True)
class SetBattery:
    """Voltage of the battery, 0…5 V.

    Raises ValueError for a value out of range.
    """

    volts: float

    def __post_init__(self) -> None:
        check(self, 0.0, 5.0, "volts")


@dataclass(frozen=True, slots=True)
class ConnectCharger:
    """Whether the battery is being charged."""

    is_connected: bool


Operating = (
    PressButton
    | MoveRobot
    | MoveObject
    | SetPen
    | DrawJumps
    | Tap
    | Tilt
    | Lift
    | Clap
    | SetNoiseLevel
    | SetAmbientLight
    | SetProximity
    | SetGround
    | SetTemperature
    | RemoteKey
    | SetBattery
    | ConnectCharger
)
