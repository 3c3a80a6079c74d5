"""Everything that comes out of a robot: one frozen value per sensor and moment.

A reading has two faces, computed together: SI fields for ROS, and `words`, the Thymio integers in
the order in which its sensor declares its Aseba variables (`sensors/…: aseba`).
"""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.sim.geometry import Pose, Twist
from thymio_sim_ros.sim.primitives import Color, Stroke


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

    `words`: ambient l r, reflected l r, delta l r (0…1023). `reflectances`: grey under each, 0…1.
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
    """Where the robot is: wheel odometry since the start, and the truth; twists in the body's frame."""

    stamp_ns: int
    words: tuple[int, ...]
    odometry: Pose
    odometry_twist: Twist
    truth: Pose
    truth_twist: Twist


@dataclass(frozen=True, slots=True)
class LedReading:
    """All lights as they shine now: (group, levels 0…32) in the order of `commands.LED_GROUPS`; sent on change."""

    stamp_ns: int
    words: tuple[int, ...]
    groups: tuple[tuple[str, tuple[int, ...]], ...]


@dataclass(frozen=True, slots=True)
class LoudspeakerReading:
    """What the loudspeaker says from `began_ns` on; sent on change.

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
)
