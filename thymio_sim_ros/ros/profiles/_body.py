"""Readings and velocities of a robot as the messages that mobile robots for courses have in common."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.ros.profiles import ProfileRobot
from thymio_sim_ros.sim.model.robot_constants import GRAVITY_M_S2

if TYPE_CHECKING:
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext
    from thymio_sim_ros.sim.commands import Command
    from thymio_sim_ros.sim.model.readings import BatteryReading, PoseReading

__all__ = ["battery", "drive", "imu", "too_fast"]

_BEFORE = "imu.before"
_ORIENTATION_VARIANCE, _RATE_VARIANCE, _ACCELERATION_VARIANCE = 1e-4, 4e-6, 3e-4


def imu(frame: str, reading: PoseReading, robot: ProfileRobot, kind: Any) -> Any:
    """Return an Imu with orientation, rates and accelerations, without noise.

    The yaw is 0 at the start. A Thymio has no gyroscope: these are the motion of the simulated body, and gravity by its
    tilt.
    """
    from thymio_sim_ros.ros.interface.convert_readings import quaternion
    from thymio_sim_ros.ros.interface.headers import stamped

    truth, twist, stamp_ns = reading.truth, reading.truth_twist, reading.stamp_ns
    start_rad, speed, before_ns = robot.memory.get(_BEFORE, (truth.yaw_rad, twist.linear_m_s, stamp_ns))
    robot.memory[_BEFORE] = (start_rad, twist.linear_m_s, stamp_ns)
    message = kind(orientation=quaternion(truth.yaw_rad - start_rad, reading.tilt))
    message.angular_velocity.z = twist.angular_rad_s
    seconds = (stamp_ns - before_ns) * 1e-9
    x, y, z = _up(message.orientation)
    forward = (twist.linear_m_s - speed) / seconds if seconds > 0.0 else 0.0
    acceleration = message.linear_acceleration
    acceleration.x = GRAVITY_M_S2 * x + forward
    acceleration.y = GRAVITY_M_S2 * y + twist.linear_m_s * twist.angular_rad_s
    acceleration.z = GRAVITY_M_S2 * z
    for covariance, variance in (
        (message.orientation_covariance, _ORIENTATION_VARIANCE),
        (message.angular_velocity_covariance, _RATE_VARIANCE),
        (message.linear_acceleration_covariance, _ACCELERATION_VARIANCE),
    ):
        covariance[::4] = (variance,) * 3
    return stamped(message, stamp_ns, robot.names.fixed_frame(frame))


def _up(q: Any) -> tuple[float, float, float]:
    """The direction that is up in the world, as the body sees it."""
    return (2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y))


def battery(frame: str, reading: BatteryReading, robot: ProfileRobot) -> Any:
    """Return a BatteryState."""
    from thymio_sim_ros.ros.interface import convert_sensors

    message = convert_sensors.battery(reading, robot.names, None)
    message.header.frame_id = robot.names.fixed_frame(frame) if frame else ""
    return message


def drive(message: Any, context: InputContext, _robot: ProfileRobot) -> Sequence[Command]:
    """Return the command of a Twist. Raises CommandError for a velocity that is no number."""
    from thymio_sim_ros.ros.interface.command_checks import body_twist

    return (body_twist(message, context.timeout_ns),)


def too_fast(message: Any) -> str:
    """Return how a Twist is clamped; empty if it is not."""
    from thymio_sim_ros.ros.interface import saturation

    return saturation.twist(message)
