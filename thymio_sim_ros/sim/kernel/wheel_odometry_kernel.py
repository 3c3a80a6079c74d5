"""Kernels: wheel odometry of many robots. They compute what `WheelArrays.roll` does, operation by operation.

Sines and cosines are numpy's, computed between `turn` and `roll`. Arrays have shape (values, robots); speeds, angles
and the like have the values of the left wheels, then of the right wheels.
"""

from __future__ import annotations

from thymio_sim_ros.sim.kernel.compiler import Floats

__all__ = ["KERNELS", "roll", "turn"]

KERNELS = ("turn", "roll")


def turn(
    count: int, dt_s: float, track_m: float, covered: Floats, ground: Floats, commanded: Floats, odometry: Floats,
    speeds: Floats, headings: Floats,
) -> None:  # fmt: skip
    """Compute the speeds at the rim, and the mean heading of the tick by odometry."""
    for wheel in range(2 * count):
        speeds[wheel] = covered[wheel] - ground[wheel] + commanded[wheel]
    for robot in range(count):
        headings[robot] = (speeds[count + robot] - speeds[robot]) / track_m * dt_s / 2.0 + odometry[2 * count + robot]


def roll(
    count: int, dt_s: float, track_m: float, radius_m: float, speeds: Floats, cosines: Floats, sines: Floats,
    odometry: Floats, angles: Floats,
) -> None:  # fmt: skip
    """Advance the odometry (x, y, yaw) and the angles of the wheels by a tick."""
    for robot in range(count):
        left = speeds[robot]
        right = speeds[count + robot]
        way = (left + right) * (dt_s / 2.0)
        odometry[robot] = cosines[robot] * way + odometry[robot]
        odometry[count + robot] = sines[robot] * way + odometry[count + robot]
        odometry[2 * count + robot] = odometry[2 * count + robot] + (right - left) / track_m * dt_s
    for wheel in range(2 * count):
        angles[wheel] = angles[wheel] + speeds[wheel] * (dt_s / radius_m)
