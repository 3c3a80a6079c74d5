"""The motion of all robots of a world: records that kernels and Python share."""

from __future__ import annotations

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints

__all__ = ["RobotState", "WheelState"]


class RobotState(Record):
    """One element per robot; elements without a robot, and robots off the floor, have `is_standing` 0."""

    is_standing: Ints
    x: Floats
    """True pose after the last tick, in m and rad."""
    y: Floats
    yaw: Floats
    speed: Floats
    """True speed along the heading, m/s."""
    turn_rate: Floats
    """True rate of turn, rad/s, counter-clockwise."""
    velocity_x: Floats
    """Velocity of a robot in contact after the last sub-step, m/s."""
    velocity_y: Floats
    is_touching: Ints
    """Whether it is in contact now."""
    was_touching: Ints
    """Whether it has been in contact in this tick."""
    cosine: Floats
    """Of the heading in the middle of the present sub-step."""
    sine: Floats
    odometry_x: Floats
    """Pose by wheel odometry, in m and rad."""
    odometry_y: Floats
    odometry_yaw: Floats
    safe_x: Floats
    """Position at which the distance to the edge of the floor was computed last, m."""
    safe_y: Floats
    safe_m: Floats
    """A lower bound of that distance; 0: it has to be computed."""


class WheelState(Record):
    """Two elements per robot: the left wheel of robot r is `2 r`, the right one `2 r + 1`; speeds in m/s at the rim."""

    wanted: Floats
    """Speed that a command asks for."""
    aimed: Floats
    """Speed that the motor gives, within the limit."""
    ground: Floats
    """Speed over ground that the wheel gives: what is aimed at, times slip."""
    covered: Floats
    """Mean speed over ground in the last tick; less than given if something was in the way."""
    rim: Floats
    """Speed at the rim in the last tick."""
    angle: Floats
    """Angle in rad by which the wheel has turned."""
    is_controlled: Ints
    """Whether the firmware's control loop drives the wheel; else it follows at once."""
    output: Floats
    """Output of the control loop, as motor.*.pwm."""
    integral: Floats
    """Integral of the control loop."""
    current: Floats
    """Filtered current, as _imot."""
    zero_ticks: Ints
    """Ticks since the loop has had a target other than 0."""
    high_ticks: Ints
    """Ticks since the current was not high."""
    is_halved: Ints
    """Whether the output is halved because of the current."""
