"""Quaternions of bodies and wheels."""

from __future__ import annotations

import math

from thymio_sim_ros.sim.model.geometry import LEVEL, Tilt

__all__ = ["rotation", "wheel_rotation"]


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
