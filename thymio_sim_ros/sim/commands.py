"""Everything that goes into the world: one frozen value per thing a robot can be told.

Commands are posted at any time and take effect at the next tick, in the order of arrival
(`World.post`). They carry SI units, except where a field is a Thymio integer by name.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

BUTTONS = ("backward", "left", "center", "forward", "right")
"""The five buttons, in the order of the firmware's variables (thymio-robot.md section 4)."""

MOTOR_MODELS = ("ideal", "firmware")
"""Without delay, or as the robot's own control loop moves them (thymio-robot.md sections 2 and 2.1)."""

LED_GROUPS: dict[str, int] = {
    "top": 3,
    "bottom_left": 3,
    "bottom_right": 3,
    "circle": 8,
    "buttons": 4,
    "proximity": 8,
    "ground": 2,
    "temperature": 2,
    "microphone": 1,
    "remote": 1,
    "battery": 3,
    "sd": 1,
}
"""LED groups and their number of lights (thymio-robot.md sections 6.3 and 8)."""

LED_GESTURES = ("circle", "blink", "kit", "alive")
"""Lights that move by themselves (ros-interface.md section 4.2)."""

LED_FULL = 32
"""Brightness of a fully lit LED (thymio-robot.md section 8.1)."""


@dataclass(frozen=True, slots=True)
class MotorTargets:
    """Wheel targets of an Aseba program, in Thymio units (int16; ±500 is full speed). They persist."""

    left: int
    right: int


@dataclass(frozen=True, slots=True)
class WheelVelocities:
    """Wheel speeds in rad/s, forward positive; they end after `timeout_ns` (0: never)."""

    left_rad_s: float
    right_rad_s: float
    timeout_ns: int = 0


@dataclass(frozen=True, slots=True)
class BodyTwist:
    """Speed of the body in m/s and rad/s (REP 103); it ends after `timeout_ns` (0: never)."""

    linear_m_s: float
    angular_rad_s: float
    timeout_ns: int = 0


@dataclass(frozen=True, slots=True)
class SetMotorModel:
    """How the motors follow from now on: one of `MOTOR_MODELS`."""

    model: str

    def __post_init__(self) -> None:
        if self.model not in MOTOR_MODELS:
            raise ValueError(f"motor model {self.model!r} found, expected one of {', '.join(MOTOR_MODELS)}")


@dataclass(frozen=True, slots=True)
class SetLeds:
    """Brightness 0…32 of every light of one group of `LED_GROUPS`; the robot's own rules no longer touch the group."""

    group: str
    levels: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SetLed:
    """Brightness 0…32 of one light by its number (thymio-robot.md section 8.2)."""

    number: int
    level: int


@dataclass(frozen=True, slots=True)
class ShowOnLeds:
    """What the robot's own rules show on one group (section 8.4): as `SetLeds`, unless somebody has taken it over."""

    group: str
    levels: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ReleaseLeds:
    """The lights of one group go off and back to the robot's own rules."""

    group: str


@dataclass(frozen=True, slots=True)
class PlayGesture:
    """Lights that move by themselves: one of `LED_GESTURES`, with a period of 0.1…60 s, negative for backwards."""

    name: str
    period_s: float

    def __post_init__(self) -> None:
        if self.name not in LED_GESTURES:
            raise ValueError(f"PlayGesture: {self.name!r} found, expected one of {', '.join(LED_GESTURES)}")
        if not 0.1 <= abs(self.period_s) <= 60.0:
            raise ValueError(f"PlayGesture: period {self.period_s:g} s found, expected 0.1 to 60, either sign")


@dataclass(frozen=True, slots=True)
class StopGesture:
    """The lights of a gesture go back to the robot's own rules."""


@dataclass(frozen=True, slots=True)
class PlayTone:
    """A tone of the current wave, limited to what the robot can play; `duration_ns` None: until stopped."""

    frequency_hz: float
    duration_ns: int | None


@dataclass(frozen=True, slots=True)
class PlaySystemSound:
    """One of the robot's own sounds 0…7 (thymio-robot.md section 9); another number is a short tone."""

    number: int


@dataclass(frozen=True, slots=True)
class PlaySamples:
    """A sound of its own: unsigned 8 bit samples at 7812.5 Hz."""

    samples: bytes


@dataclass(frozen=True, slots=True)
class StopSound:
    """Silence; a sound that is stopped has not finished."""


@dataclass(frozen=True, slots=True)
class SetWave:
    """The period that tones are made of: 142 samples −128…127."""

    samples: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SetVolume:
    """Volume of the loudspeaker as bits that samples lose: 0 is loudest, 8 is off (section 9)."""

    shift: int


@dataclass(frozen=True, slots=True)
class SetAlarm:
    """While it is on, the sound of an arrow button every three seconds."""

    is_on: bool


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
class ResetOdometry:
    """Let the wheel odometry start again from zero, here."""


@dataclass(frozen=True, slots=True)
class Tap:
    """A knock on the robot's body."""


@dataclass(frozen=True, slots=True)
class Tilt:
    """Hold the robot at an angle until told otherwise: rad, ±pi; roll lifts its left side, pitch lowers its front."""

    roll_rad: float
    pitch_rad: float

    def __post_init__(self) -> None:
        _check(self, -math.pi, math.pi, "roll_rad", "pitch_rad")


@dataclass(frozen=True, slots=True)
class Clap:
    """A clap beside the robot, as loud as mic.intensity tells, 0…255; other robots hear it by their distance."""

    intensity: int

    def __post_init__(self) -> None:
        _check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetNoiseLevel:
    """A steady noise round this robot alone, as mic.intensity tells it, 0…255."""

    intensity: int

    def __post_init__(self) -> None:
        _check(self, 0, 255, "intensity")


@dataclass(frozen=True, slots=True)
class SetAmbientLight:
    """Light that reaches the ground sensors besides their own, as prox.ground.ambiant tells it, 0…1023."""

    level: int

    def __post_init__(self) -> None:
        _check(self, 0, 1023, "level")


@dataclass(frozen=True, slots=True)
class SetTemperature:
    """Temperature round the robot in °C, -40…85."""

    celsius: float

    def __post_init__(self) -> None:
        _check(self, -40.0, 85.0, "celsius")


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
        _check(self, 0, 31, "address")
        _check(self, 0, 127, "command")


@dataclass(frozen=True, slots=True)
class SetBattery:
    """Voltage of the battery, 0…5 V."""

    volts: float

    def __post_init__(self) -> None:
        _check(self, 0.0, 5.0, "volts")


@dataclass(frozen=True, slots=True)
class ConnectCharger:
    """Whether the battery is being charged."""

    is_connected: bool


@dataclass(frozen=True, slots=True)
class SetSoundThreshold:
    """mic.threshold: a sound above it is told, 0 is off (int16)."""

    level: int

    def __post_init__(self) -> None:
        _check(self, -0x8000, 0x7FFF, "level")


@dataclass(frozen=True, slots=True)
class EnableComm:
    """Infrared communication on or off; off forgets what was sent."""

    is_enabled: bool


@dataclass(frozen=True, slots=True)
class SetCommPayload:
    """prox.comm.tx: the value sent in every frame, at most 2047 counts; a negative one is no data (int16)."""

    value: int

    def __post_init__(self) -> None:
        _check(self, -0x8000, 0x7FFF, "value")


def _check(command: object, low: float, high: float, *fields: str) -> None:
    """ValueError unless these fields lie in a range (NaN does not)."""
    for field in fields:
        value = getattr(command, field)
        if not low <= value <= high:
            raise ValueError(f"{type(command).__name__}: {field} {value} found, expected {low:g} to {high:g}")


class PluginCommand:
    """Base of the commands that a plug-in brings along (docs/plugins.md)."""

    __slots__ = ()


Command = (
    MotorTargets
    | WheelVelocities
    | BodyTwist
    | SetMotorModel
    | SetLeds
    | SetLed
    | ShowOnLeds
    | ReleaseLeds
    | PlayGesture
    | StopGesture
    | PlayTone
    | PlaySystemSound
    | PlaySamples
    | StopSound
    | SetWave
    | SetVolume
    | SetAlarm
    | SetPen
    | PressButton
    | MoveRobot
    | MoveObject
    | ResetOdometry
    | Tap
    | Tilt
    | Clap
    | SetNoiseLevel
    | SetAmbientLight
    | SetTemperature
    | RemoteKey
    | SetBattery
    | ConnectCharger
    | SetSoundThreshold
    | EnableComm
    | SetCommPayload
    | PluginCommand
)
