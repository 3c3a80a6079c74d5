"""Everything that comes out of a robot: one frozen value per sensor and moment.

A reading has two faces, computed together: SI fields for ROS, and `words`, the Thymio integers in
the order in which its sensor declares its Aseba variables (`sensors/…: aseba`).
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.model import units
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.primitives import Color, Stroke


@dataclass(frozen=True, slots=True)
class ProximityReading:
    """Seven horizontal proximity sensors: left, center_left, center, center_right, right, rear_left, rear_right.

    `words` are counts 0…4505; `ranges_m` is the distance along the axis of a wall that gives this count, as the robot's
    driver computes it, at most 0.14 (inf: nothing within range, count 0).
    """

    stamp_ns: int
    words: tuple[int, ...]
    ranges_m: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class GroundReading:
    """Two ground sensors, left then right.

    `words`: ambient l r, reflected l r, delta l r (0…1023). `reflectances`: gray under each, 0…1.
    """

    stamp_ns: int
    words: tuple[int, ...]
    reflectances: tuple[float, float]


@dataclass(frozen=True, slots=True)
class ButtonsReading:
    """The five buttons in the order of `commands.BUTTONS`; `words` are 0 or 1."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class MotorReading:
    """The wheels: angles in rad (not wrapped) and speeds in rad/s, left then right.

    `words`: motor.left.speed, motor.right.speed, motor.left.pwm, motor.right.pwm.
    """

    stamp_ns: int
    words: tuple[int, ...]
    angles_rad: tuple[float, float]
    velocities_rad_s: tuple[float, float]


@dataclass(frozen=True, slots=True)
class PoseReading:
    """The pose of the robot: wheel odometry since the start, and the truth; twists in the body's frame.

    `tilt` is how it leans, `height_m` how high an operator holds it.
    """

    stamp_ns: int
    words: tuple[int, ...]
    odometry: Pose
    odometry_twist: Twist
    truth: Pose
    truth_twist: Twist
    tilt: Tilt = LEVEL
    height_m: float = 0.0


@dataclass(frozen=True, slots=True)
class LedReading:
    """All lights as they shine now: (group, levels 0…32) in the order of `commands.LED_GROUPS`; sent on change."""

    stamp_ns: int
    words: tuple[int, ...]
    groups: tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class LoudspeakerReading:
    """The sound of the loudspeaker from `began_ns` on; sent on change.

    A tone of `frequency_hz` made of `wave`, for `duration_ns` (None: until stopped); or `samples`, unsigned 8 bit at
    7812.5 Hz, with frequency 0; or silence, with neither. Samples lose `shift` bits: 0 is loudest, 8 is off.
    """

    stamp_ns: int
    words: tuple[int, ...]
    began_ns: int
    frequency_hz: float
    duration_ns: int | None
    wave: tuple[int, ...]
    samples: bytes
    shift: int


@dataclass(frozen=True, slots=True)
class PenReading:
    """The pen: whether it is down, red, green, blue 0…1, width in m, whether it erases; sent on change.

    `strokes`: all that it drew, the oldest first.
    """

    stamp_ns: int
    words: tuple[int, ...]
    down: bool
    color: Color
    width_m: float
    erase: bool
    strokes: tuple[Stroke, ...]


@dataclass(frozen=True, slots=True)
class SoundFinishedReading:
    """A sound came to its natural end."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class AccelerometerReading:
    """Proper acceleration; `words`: acc, 23 for each g: right, forward, up (docs/spec/thymio-robot.md section 7.3)."""

    stamp_ns: int
    words: tuple[int, ...]

    @property
    def acceleration_m_s2(self) -> tuple[float, float, float]:
        """The same in m/s² (about 9.81 upwards at rest): forward, left, up."""
        right, forward, up = map(units.units_to_acceleration, self.words)
        return (forward, -right, up)


@dataclass(frozen=True, slots=True)
class TapReading:
    """A shock was felt; `words`: acc._tap, 1."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class SoundReading:
    """The microphone; `words`: mic.intensity 0…255, mic._mean 0…510. `is_loud`: above the threshold that is set."""

    stamp_ns: int
    words: tuple[int, ...]
    is_loud: bool


@dataclass(frozen=True, slots=True)
class TemperatureReading:
    """Temperature in °C; `words` are its tenths."""

    stamp_ns: int
    words: tuple[int, ...]
    celsius: float


@dataclass(frozen=True, slots=True)
class RemoteReading:
    """A new frame of a remote control; `words`: address 0…31, command 0…127."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class ButtonCountsReading:
    """The capacitive buttons inside; `words`: five counts, their slow means, their noise, in the order of `BUTTONS`."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class BatteryReading:
    """The battery: volts, charge 0…1; `words`: _vbat, whose sum times 1000/3978 is centivolts; and is_charging."""

    stamp_ns: int
    words: tuple[int, ...]
    volts: float
    charge: float
    is_charging: bool


@dataclass(frozen=True, slots=True)
class CurrentReading:
    """The motors inside; `words`: _imot left, right (600 is about 0.4 A), _integrator left, right (±4806)."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CommReading:
    """An infrared frame was heard; `words`: the value 0…2047, then values and intensities of the seven sensors."""

    stamp_ns: int
    words: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class CollisionReading:
    """Whether the robot touches anything but the floor; sent on change. Programs see nothing of it."""

    stamp_ns: int
    words: tuple[int, ...]
    is_touching: bool


@dataclass(frozen=True, slots=True)
class LidarReading:
    """A scan of a `lidar`: distances in m by beam (inf: nothing within range). Programs see nothing of it."""

    stamp_ns: int
    words: tuple[int, ...]
    ranges_m: tuple[float, ...]
    lidar: Lidar


@dataclass(frozen=True, slots=True)
class PlainReading:
    """A reading of words alone: enough for the sensor of a plug-in (docs/plugins.md)."""

    stamp_ns: int
    words: tuple[int, ...]


Reading = (
    ProximityReading
    | GroundReading
    | ButtonsReading
    | MotorReading
    | PoseReading
    | LedReading
    | LoudspeakerReading
    | PenReading
    | SoundFinishedReading
    | AccelerometerReading
    | TapReading
    | SoundReading
    | TemperatureReading
    | RemoteReading
    | ButtonCountsReading
    | BatteryReading
    | CurrentReading
    | CommReading
    | CollisionReading
    | LidarReading
    | PlainReading
)
