"""What somebody does to the robot from outside: fingers, hands, voices, light, pen."""

from __future__ import annotations

import math
from dataclasses import dataclass

from thymio_sim_ros.sim.commands._limits import check, check_counts

__all__ = [
    "BUTTONS",
    "Clap",
    "ConnectCharger",
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
    """A finger put on (or taken off) one of `BUTTONS`."""

    button: str
    pressed: bool


@dataclass(frozen=True, slots=True)
class MoveRobot:
    """Put the robot somewhere (metres, radians, world frame); its odometry does not notice."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class MoveObject:
    """Put a movable thing somewhere, at rest (metres, radians, world frame)."""

    x_m: float
    y_m: float
    yaw_rad: float


@dataclass(frozen=True, slots=True)
class SetPen:
    """The pen in the pen hole, put in by an operator; None leaves a property as it is.

    `color`: red, green, blue 0…1; `width_m` 0.001…0.1; `erase`: it takes drawings away instead.
    """

    down: bool | None = None
    color: tuple[float, float, float] | None = None
    width_m: float | None = None
    erase: bool | None = None


@dataclass(frozen=True, slots=True)
class Tap:
    """A knock on the robot's body."""


@dataclass(frozen=True, slots=True)
class Tilt:
    """Hold the robot at an angle until told otherwise: rad, ±pi; roll lifts its left side, pitch lowers its front."""

    roll_rad: float
    pitch_rad: float

    def __post_init__(self) -> None:
        check(self, -math.pi, math.pi, "roll_rad", "pitch_rad")


@dataclass(frozen=True, slots=True)
class Clap:
    """A clap beside the robot, as loud as mic.intensity tells, 0…255; other robots hear it by their distance."""

    intensity: int

    def __post_init__(self) -> None:
        check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetNoiseLevel:
    """A steady noise round this robot alone, as mic.intensity tells it, 0…255."""

    intensity: int

    def __post_init__(self) -> None:
        check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetAmbientLight:
    """Light that reaches the ground sensors besides their own, as prox.ground.ambiant tells it, 0…1023."""

    level: int

    def __post_init__(self) -> None:
        check(self, 0, 1023, "level")


@dataclass(frozen=True, slots=True)
class SetProximity:
    """What the seven proximity sensors count from now on, 0…4505 in Thymio's order; -1: what it sees by itself."""

    counts: tuple[int, ...]

    def __post_init__(self) -> None:
        check_counts(self, self.counts, 7, 4505)


@dataclass(frozen=True, slots=True)
class SetGround:
    """What the two ground sensors count of their own light from now on, 0…1023; -1: what it sees by itself."""

    counts: tuple[int, ...]

    def __post_init__(self) -> None:
        check_counts(self, self.counts, 2, 1023)


@dataclass(frozen=True, slots=True)
class SetTemperature:
    """Temperature round the robot in °C, -40…85."""

    celsius: float

    def __post_init__(self) -> None:
        check(self, -40.0, 85.0, "celsius")


@dataclass(frozen=True, slots=True)
class RemoteKey:
    """A frame of an RC5 remote control: address 0…31, command 0…127.

    A frame that repeats address, command and toggle bit of the one before is the same key still held, and ignored.
    Without a `toggle`, it is a new press.
    """

    address: int
    command: int
    toggle: bool | None = None

    def __post_init__(self) -> None:
        check(self, 0, 31, "address")
        check(self, 0, 127, "command")


@dataclass(frozen=True, slots=True)
class SetBattery:
    """Voltage of the battery, 0…5 V."""

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
    | Tap
    | Tilt
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
