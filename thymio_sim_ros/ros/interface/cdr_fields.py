"""The numeric fields of messages by reading, and the patches that write them into serialized templates."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any, TypeAlias

from thymio_sim_ros.ros.interface.cdr_templates import Patch, Span
from thymio_sim_ros.sim.commands import LED_FULL, LED_GROUPS
from thymio_sim_ros.sim.model import readings, robot_constants, units
from thymio_sim_ros.sim.model.geometry import LEVEL, Pose, Tilt, Twist

__all__ = [
    "BATTERY",
    "IMU",
    "JOINTS",
    "JOY",
    "LASER",
    "LEDS",
    "ODOMETRY",
    "RAYS",
    "TEMPERATURE",
    "TRUTH",
    "gray",
    "ground_patch",
    "ground_range_m",
    "laser_m",
    "led_levels",
    "proximity_patch",
    "proximity_range_m",
    "ray_lines",
    "reflectance_patch",
    "rotation",
    "wheel_rotation",
    "words_patch",
]

Point: TypeAlias = tuple[float, float, float]
Color: TypeAlias = tuple[float, float, float, float]

# The driver's constants (docs/spec/ros-interface.md section 3).
PROXIMITY_MIN_M, LASER_OFFSET_M = 0.0215, 0.08


def rotation(yaw_rad: float, tilt: Tilt = LEVEL) -> tuple[float, float, float, float]:
    """Return the quaternion x, y, z, w, with w >= 0, of a body that is tilted, then turned about z."""
    z, w = math.sin(yaw_rad / 2), math.cos(yaw_rad / 2)
    if tilt == LEVEL:
        return (0.0, 0.0, z, w) if w >= 0.0 else (0.0, 0.0, -z, -w)
    sr, cr = math.sin(tilt.roll_rad / 2), math.cos(tilt.roll_rad / 2)
    sp, cp = math.sin(tilt.pitch_rad / 2), math.cos(tilt.pitch_rad / 2)
    turn = (
        w * cp * sr - z * sp * cr,
        w * sp * cr + z * cp * sr,
        z * cp * cr - w * sp * sr,
        w * cp * cr + z * sp * sr,
    )
    return turn if turn[3] >= 0.0 else (-turn[0], -turn[1], -turn[2], -turn[3])


def wheel_rotation(angle_rad: float) -> tuple[float, float, float, float]:
    """Return the quaternion x, y, z, w, with w >= 0, of a turn about the axle, which is the y axis."""
    y, w = math.sin(angle_rad / 2), math.cos(angle_rad / 2)
    return (0.0, y, 0.0, w) if w >= 0.0 else (0.0, -y, 0.0, -w)


def proximity_range_m(reading: readings.ProximityReading, options: Any, index: int) -> float:
    """Return the range of a proximity sensor in m, or the value for no obstacle or for one that is too close."""
    value, nearest = reading.ranges_m[index], options.proximity[index].min_m
    if options.driver_ranges:
        return -1.0 if math.isinf(value) else max(value, nearest)
    return -math.inf if value < nearest else value


def ground_range_m(reading: readings.GroundReading, options: Any, index: int) -> float:
    """Return the range that stands for a floor that reflects, or does not."""
    dark = reading.words[4 + index] < options.ground_threshold
    not_reflecting, reflecting = (1.0, 0.0) if options.driver_ranges else (math.inf, -math.inf)
    return not_reflecting if dark else reflecting


def gray(reading: readings.GroundReading, index: int) -> float:
    """Return the gray 0…1 that corresponds to the count of a ground sensor without ambient light."""
    return units.ground_reflectance(reading.words[4 + index])


def ray_lines(reading: readings.ProximityReading) -> tuple[list[Point], list[Color]]:
    """Return both ends of the seven rays in m, and a color for each end: red if there is an obstacle."""
    ends: list[Point] = []
    colors: list[Color] = []
    for (x, y, dx, dy), range_m in zip(_RAYS, reading.ranges_m, strict=True):
        is_free = math.isinf(range_m)
        length = robot_constants.PROXIMITY_RANGE_M if is_free else range_m
        ends += (
            (x, y, robot_constants.PROXIMITY_HEIGHT_M),
            (x + length * dx, y + length * dy, robot_constants.PROXIMITY_HEIGHT_M),
        )
        colors += (_FREE if is_free else _HIT,) * 2
    return ends, colors


_RAYS = tuple((x, y, math.cos(yaw), math.sin(yaw)) for x, y, yaw in robot_constants.PROXIMITY_POSES)
_FREE: Color = (0.45, 0.75, 1.0, 0.6)
_HIT: Color = (1.0, 0.3, 0.2, 1.0)
"""Colors of rays without and with an obstacle."""


def laser_m(reading: readings.ProximityReading) -> list[float]:
    """Return the ranges of the front sensors in m from the robot's center, from right to left as in LaserScan."""
    return [
        math.inf if math.isinf(range_m) else max(range_m, PROXIMITY_MIN_M) + LASER_OFFSET_M
        for range_m in reading.ranges_m[4::-1]
    ]


def _range_patch(seen: Callable[[Any, Any, int], float], index: int) -> Patch:
    """Return the patch of a Range: the message ends with range and variance."""
    return Patch((Span(struct.Struct("<ff"), lambda reading, options: (seen(reading, options, index), 0.0)),))


def _laser_numbers(reading: readings.ProximityReading, _options: Any) -> Sequence[float]:
    counts = reading.words[4::-1]
    return (*laser_m(reading), len(counts), *counts)


def _ray_numbers(reading: readings.ProximityReading, _options: Any) -> Sequence[float]:
    ends, colors = ray_lines(reading)
    return (*chain.from_iterable(ends), len(colors), *chain.from_iterable(colors))


def _battery_numbers(reading: readings.BatteryReading, _options: Any) -> Sequence[float]:
    return (reading.volts, *(math.nan,) * 5, reading.charge, charging_status(reading))


def charging_status(reading: readings.BatteryReading) -> int:
    """Return the power supply status of BatteryState."""
    return CHARGING if reading.is_charging else DISCHARGING


CHARGING, DISCHARGING = 1, 2


def _joint_numbers(reading: readings.MotorReading, _options: Any) -> Sequence[float]:
    return (*reading.angles_rad, 2, *reading.velocities_rad_s)


def _odometry_patch(
    place: Callable[[readings.PoseReading], tuple[Pose, float, Sequence[float]]],
    twist: Callable[[readings.PoseReading], Twist],
) -> Patch:
    """Return the patch of an Odometry: it ends with pose, covariance, twist, covariance; covariances stay."""

    def place_numbers(reading: readings.PoseReading, _options: Any) -> Sequence[float]:
        pose, height_m, turn = place(reading)
        return (pose.x_m, pose.y_m, height_m, *turn)

    def twist_numbers(reading: readings.PoseReading, _options: Any) -> Sequence[float]:
        moves = twist(reading)
        return (moves.linear_m_s, 0.0, 0.0, 0.0, 0.0, moves.angular_rad_s)

    return Patch(
        (
            Span(struct.Struct("<7d"), place_numbers, behind=2 * _COVARIANCE_BYTES + 6 * 8),
            Span(struct.Struct("<6d"), twist_numbers, behind=_COVARIANCE_BYTES),
        )
    )


_COVARIANCE_BYTES = 36 * 8


def led_levels(reading: readings.LedReading) -> list[float]:
    """Return the intensities 0…1 of all lights."""
    return [level / LED_FULL for _, levels in reading.groups for level in levels]


def words_patch(count: int) -> Patch | None:
    """Return the patch of an array of `count` integers; None if it is empty."""
    if not count:
        return None
    return Patch((Span(struct.Struct(f"<{count}h"), lambda reading, _options: reading.words),), has_stamp=False)


def proximity_patch(index: int) -> Patch:
    """Return the patch of the Range of one proximity sensor."""
    return _range_patch(proximity_range_m, index)


def ground_patch(index: int) -> Patch:
    """Return the patch of the Range of one ground sensor."""
    return _range_patch(ground_range_m, index)


def reflectance_patch(index: int) -> Patch:
    """Return the patch of the reflectance of one ground sensor."""
    return Patch((Span(struct.Struct("<f"), lambda reading, _options: (gray(reading, index),)),), has_stamp=False)


ODOMETRY = _odometry_patch(
    lambda reading: (reading.odometry, 0.0, rotation(reading.odometry.yaw_rad)), lambda reading: reading.odometry_twist
)
TRUTH = _odometry_patch(
    lambda reading: (reading.truth, reading.height_m, rotation(reading.truth.yaw_rad, reading.tilt)),
    lambda reading: reading.truth_twist,
)
JOINTS = Patch((Span(struct.Struct("<2dI4x2d"), _joint_numbers, behind=8),))
"""Two positions and two velocities; the empty effort after them is aligned as if it had values."""
LASER = Patch((Span(struct.Struct("<5fI5f"), _laser_numbers),))
LEDS = Patch(
    (Span(struct.Struct(f"<{sum(LED_GROUPS.values())}f"), lambda reading, _options: led_levels(reading)),),
    has_stamp=False,
)
RAYS = Patch((Span(struct.Struct("<42dI56f"), _ray_numbers, behind=69),))
"""Points and colors; the rest is an empty texture, empty texts and an empty mesh."""
IMU = Patch((Span(struct.Struct("<3d"), lambda reading, _options: reading.acceleration_m_s2, behind=9 * 8),))
JOY = Patch((Span(struct.Struct("<5i"), lambda reading, _options: reading.words),))
BATTERY = Patch((Span(struct.Struct("<7fB"), _battery_numbers, behind=24),))
"""All fields up to the status; the rest is constant, or empty cells and texts."""
TEMPERATURE = Patch((Span(struct.Struct("<d"), lambda reading, _options: (reading.words[0] / 10,), behind=8),))
