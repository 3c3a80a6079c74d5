"""The Thymio II in numbers; every one names its source in docs/spec/thymio-robot.md, cited here as "section", or says
where it comes from."""

from __future__ import annotations

import math

HULL_RADIUS_M = 0.080
"""Radius of the round front about the origin, which lies between the wheels (section 1.1)."""
HULL_WIDTH_M = 0.110
"""Width of the collision outline (section 1.1)."""
HULL_REAR_X_M = -0.030
"""Position of the straight rear (section 1.1)."""
HULL_HEIGHT_M = 0.051
"""Height of the collision outline, which other robots see (sections 1 and 1.1)."""
BODY_HEIGHT_M = 0.053
"""Height as drawn (section 1)."""
MASS_KG = 0.27
"""Mass of the robot (section 1)."""

WHEEL_TRACK_M = 0.094
"""Distance between the wheels' contact points (section 1)."""
WHEEL_RADIUS_M = 0.022
"""Only turns ground speed into wheel angles (section 1)."""
WHEEL_WIDTH_M = 0.015
"""Only drawn (section 1)."""

MAX_SPEED_M_S = 0.166
"""Ground speed of a wheel at target 500, and its limit (section 2)."""
FULL_TARGET = 500
"""The target that gives the full speed (section 2)."""
SLIP = (0.973, 1.027)
"""Range of the uniform factor on each wheel's ground speed in each control step (section 2)."""
PWM_PER_SPEED_UNIT = -1.6
"""motor.*.pwm for each unit of speed; the sign is opposite (section 2)."""
PWM_LIMIT = 801
"""Limit of motor.*.pwm (section 2.1)."""

DRIVE_FORCE_N = 2.65
"""The most that the tires can push: the weight, as rubber grips. Own choice: section 11 asks for a finite force."""

PROXIMITY_POSES: tuple[tuple[float, float, float], ...] = (
    (0.062, 0.0485, math.radians(40)),
    (0.075, 0.0255, math.radians(20)),
    (0.0795, 0.0, 0.0),
    (0.075, -0.0255, math.radians(-20)),
    (0.062, -0.0485, math.radians(-40)),
    (-0.0295, 0.0295, math.pi),
    (-0.0295, -0.0295, math.pi),
)
"""x, y, heading of the proximity sensors in Thymio's order 0…6: left to right, then rear left, rear right (section
7.1)."""
PROXIMITY_MODELS = ("default", "enki", "cone")
"""Models of proximity sensors; `sensors.proximity` has the equations."""

PROXIMITY_HEIGHT_M = 0.034
"""Lower things are not seen (section 7.1)."""
PROXIMITY_RANGE_M = 0.14
"""Nothing is seen beyond (section 7.1)."""
PROXIMITY_HALF_CONE_RAD = math.radians(15)
"""The side rays of a sensor lie this far from its axis (section 7.1)."""
PROXIMITY_NOISE = 2.87
"""Standard deviation of a count (section 7.1)."""

GROUND_SENSORS: tuple[tuple[float, float], ...] = ((0.072, 0.0115), (0.072, -0.0115))
"""x, y of the ground sensors, left then right (section 7.2)."""
GROUND_NOISE = 10.0
"""Standard deviation of a ground count (section 7.2)."""

GRAVITY_M_S2 = 9.81
"""As the robot's driver takes it (docs/spec/ros-interface.md section 3)."""
ACC_PER_G = 23
"""Counts of acc for each g (section 7.3)."""
ACC_LIMIT = 32
"""Limit of each count of acc (section 7.3)."""
ACC_NOISE = 0.2
"""Largest deviation of a count before rounding, all as likely. Own choice: the mean of 21 samples is steady at rest."""
TAP_SPEED_M_S = 0.02
"""A contact that begins faster than this is a tap (section 7.3)."""

INTEGRATOR_LIMIT = 4806
"""Limit of _integrator (section 2.1)."""

REFRESH_NS = 1_000_000_000
"""Values that are reported on change are reported once a second, too, for programs that were reset meanwhile.
Own choice."""


def hull() -> tuple[tuple[float, float], ...]:
    """The collision outline in m, counter-clockwise from the front right (section 1.1)."""
    corner = math.asin(HULL_WIDTH_M / 2 / HULL_RADIUS_M)
    front = tuple(
        (HULL_RADIUS_M * math.cos(angle), HULL_RADIUS_M * math.sin(angle))
        for angle in (-corner + corner * step / 5 for step in range(11))
    )
    return (*front, (HULL_REAR_X_M, HULL_WIDTH_M / 2), (HULL_REAR_X_M, -HULL_WIDTH_M / 2))
