"""The motion of all robots of a world: one record that kernels and Python share."""

from __future__ import annotations

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints

__all__ = ["RobotState"]


class RobotState(Record):
    """One element per robot; robots that are not there, or have fallen, have `is_standing` 0."""

    is_standing: Ints
    aimed_left: Floats
    """Speeds in m/s at the rim that the motors aim at."""
    aimed_right: Floats
    ground_left: Floats
    """Speeds in m/s over ground that the wheels give: what is aimed at, times slip."""
    ground_right: Floats
    covered_left: Floats
    """Speeds in m/s over ground at the wheels, mean of the last tick; less than given if something was in the way."""
    covered_right: Floats
    rim_left: Floats
    """Speeds in m/s at the rim in the last tick."""
    rim_right: Floats
    angle_left: Floats
    """Angles in rad by which the wheels have turned."""
    angle_right: Floats
    odometry_x: Floats
    """Pose by wheel odometry, in m and rad."""
    odometry_y: Floats
    odometry_yaw: Floats
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
