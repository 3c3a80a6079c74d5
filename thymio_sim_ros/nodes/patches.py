"""The numbers of readings as messages hold them, and how they are patched into templates of much traffic."""

from __future__ import annotations

import math
import struct
from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

from thymio_sim_ros.nodes.templates import Patch
from thymio_sim_ros.sim import readings
from thymio_sim_ros.sim.geometry import LEVEL, Pose, Tilt, Twist

__all__ = ["ODOMETRY", "TRUTH", "below_m", "below_patch", "rotation", "seen_m", "seen_patch", "words_patch"]


def rotation(yaw_rad: float, tilt: Tilt = LEVEL) -> tuple[float, float, float, float]:
    """A turn about z, of a body that leans, as x, y, z, w."""
    z, w = math.sin(yaw_rad / 2), math.cos(yaw_rad / 2)
    if tilt == LEVEL:
        return (0.0, 0.0, z, w)
    sr, cr = math.sin(tilt.roll_rad / 2), math.cos(tilt.roll_rad / 2)
    sp, cp = math.sin(tilt.pitch_rad / 2), math.cos(tilt.pitch_rad / 2)
    return (
        w * cp * sr - z * sp * cr,
        w * sp * cr + z * cp * sr,
        z * cp * cr - w * sp * sr,
        w * cp * cr + z * sp * sr,
    )


def seen_m(reading: readings.ProximityReading, options: Any, index: int) -> float:
    """A proximity sensor's range in m, or what stands for nothing and too close."""
    value, nearest = reading.ranges_m[index], options.proximity[index].min_m
    if options.driver_ranges:
        return -1.0 if math.isinf(value) else max(value, nearest)
    return -math.inf if value < nearest else value


def below_m(reading: readings.GroundReading, options: Any, index: int) -> float:
    """What stands for a floor that reflects, or does not."""
    dark = reading.words[4 + index] < options.ground_threshold
    not_reflecting, reflecting = (1.0, 0.0) if options.driver_ranges else (math.inf, -math.inf)
    return not_reflecting if dark else reflecting


_RANGE_TAIL = struct.Struct("<ff")
"""range, variance"""
_ODOMETRY_TAIL = struct.Struct("<85d")
"""Pose, its covariance, twist, its covariance."""


def _range_patch(seen_m: Callable[[Any, Any, int], float], index: int) -> Patch:
    return Patch(_RANGE_TAIL, lambda reading, options: (seen_m(reading, options, index), 0.0))


def _odometry_numbers(reading: readings.PoseReading, options: Any) -> Sequence[float]:
    pose_variances, twist_variances = _square(options.pose_covariance), _square(options.twist_covariance)
    pose, twist, turn = reading.odometry, reading.odometry_twist, rotation(reading.odometry.yaw_rad)
    if not any(options.pose_covariance):
        twist_variances = _square((0.0,) * 6)
    return _numbers(pose, turn, pose_variances, twist, twist_variances)


def _truth_numbers(reading: readings.PoseReading, _options: Any) -> Sequence[float]:
    nothing = _square((0.0,) * 6)
    return _numbers(reading.truth, rotation(reading.truth.yaw_rad, reading.tilt), nothing, reading.truth_twist, nothing)


def _numbers(
    pose: Pose, turn: Sequence[float], pose_variances: Sequence[float], twist: Twist, twist_variances: Sequence[float]
) -> Sequence[float]:
    still = (0.0, 0.0, 0.0, 0.0)
    return (
        *(pose.x_m, pose.y_m, 0.0),
        *turn,
        *pose_variances,
        *(twist.linear_m_s, *still, twist.angular_rad_s),
        *twist_variances,
    )


@cache
def _square(diagonal: tuple[float, ...]) -> tuple[float, ...]:
    """A covariance with these variances, row by row."""
    return tuple(value if row == column else 0.0 for row, value in enumerate(diagonal) for column in range(6))


def words_patch(count: int) -> Patch | None:
    """Of so many words; None for none."""
    return (
        Patch(struct.Struct(f"<{count}h"), lambda reading, _options: reading.words, has_stamp=False) if count else None
    )


def seen_patch(index: int) -> Patch:
    """Of one proximity sensor's Range."""
    return _range_patch(seen_m, index)


def below_patch(index: int) -> Patch:
    """Of one ground sensor's Range."""
    return _range_patch(below_m, index)


ODOMETRY = Patch(_ODOMETRY_TAIL, _odometry_numbers)
TRUTH = Patch(_ODOMETRY_TAIL, _truth_numbers)
