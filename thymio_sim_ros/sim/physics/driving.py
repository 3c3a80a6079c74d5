"""Kernels: how wheels move a robot's body.

A free robot has the speed of its wheels; its velocity points along the heading in the middle of the sub-step, so that
its path follows arcs to the third order. pymunk moves bodies first and solves contacts and forces afterwards; a robot
in contact is therefore pushed by a force, which that solution takes into account: it would give the robot the speed of
its wheels within a tick, as Enki imposes, but never exceeds the grip of the tires, so that heavy objects stall it.
Wheels at rest resist a push in the same way, and two robots share the difference of their speeds. Wheels hold the
heading (docs/spec/thymio-robot.md section 11).
"""

from __future__ import annotations

import math

from aseba_vm.kernel.types import Floats, Ints, kernel
from thymio_sim_ros.sim.kernel.elementary import cos, sin
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, TICK_S

__all__ = ["MOMENT_KG_M2", "PUSH_N_S_M", "push", "read_motion", "read_poses"]

MOMENT_KG_M2 = 1.0
"""Far above the real one: wheels hold the heading of a robot that hits a wall.

Source: docs/spec/thymio-robot.md section 11.
"""
PUSH_N_S_M = robot_constants.MASS_KG / TICK_S
"""Force for each m/s that a robot in contact lacks: enough to make up for it in one tick."""

_TRACK_M = robot_constants.WHEEL_TRACK_M
_GRIP_N = robot_constants.DRIVE_FORCE_N
_TORQUE_N_M_S = MOMENT_KG_M2 / SUB_STEP_S
_SUB_STEP_S = SUB_STEP_S
_SUB_STEPS = SUB_STEPS


@kernel
def push(robots: RobotState, wheels: WheelState, orders: Floats) -> None:
    """Before a sub-step: set the speed of the wheels, or in contact a force toward it, limited by the grip.

    `orders` has six values for each standing robot: velocity x, y, rate of turn, force x, y, torque.
    """
    place = 0
    for robot in range(robots.count):
        if robots.is_standing[robot] == 0:
            continue
        speed = (wheels.ground[2 * robot] + wheels.ground[2 * robot + 1]) / 2.0
        turn_rate = (wheels.ground[2 * robot + 1] - wheels.ground[2 * robot]) / _TRACK_M
        heading = robots.yaw[robot] + turn_rate / 2.0 * _SUB_STEP_S
        if robots.is_touching[robot] == 0:
            robots.speed[robot] = speed
            robots.turn_rate[robot] = turn_rate
            robots.yaw[robot] = robots.yaw[robot] + turn_rate * _SUB_STEP_S
            cosine = cos(heading)
            sine = sin(heading)
            orders[place] = speed * cosine
            orders[place + 1] = speed * sine
            orders[place + 2] = turn_rate
            orders[place + 3] = 0.0
            orders[place + 4] = 0.0
            orders[place + 5] = 0.0
        else:
            # pymunk integrates the velocity of the last sub-step first, so the body turns by it before this force acts;
            # the heading in the middle of the sub-step after that is where the wheels will point.
            heading = heading + robots.turn_rate[robot] * _SUB_STEP_S
            cosine = cos(heading)
            sine = sin(heading)
            force_x = (speed * cosine - robots.velocity_x[robot]) * PUSH_N_S_M
            force_y = (speed * sine - robots.velocity_y[robot]) * PUSH_N_S_M
            # The force is scaled down to the grip of the tires in its own direction. The torque is not limited: wheels
            # hold the heading, with the large moment of inertia.
            share = _GRIP_N / max(_GRIP_N, math.sqrt(force_x * force_x + force_y * force_y))
            orders[place] = robots.velocity_x[robot]
            orders[place + 1] = robots.velocity_y[robot]
            orders[place + 2] = robots.turn_rate[robot]
            orders[place + 3] = force_x * share
            orders[place + 4] = force_y * share
            orders[place + 5] = (turn_rate - robots.turn_rate[robot]) * _TORQUE_N_M_S
        robots.cosine[robot] = cosine
        robots.sine[robot] = sine
        place = place + 6


@kernel
def read_motion(robots: RobotState, wheels: WheelState, rows: Ints, bodies: Floats, earlier: Ints) -> None:
    """After a sub-step: read the motion that contacts allowed to the robots that are in contact or were in this tick.

    `bodies` has six values for each body: x, y, angle, velocity x, y, rate of turn; `rows` are the robots' rows there.
    `earlier[0]` sub-steps of this tick came before.
    """
    for robot in range(robots.count):
        if robots.is_standing[robot] == 0 or robots.is_touching[robot] + robots.was_touching[robot] == 0:
            continue
        if robots.was_touching[robot] == 0:
            robots.was_touching[robot] = 1
            # The contact began in this sub-step: in the earlier ones the robot had the speed of the wheels.
            part = float(earlier[0]) / _SUB_STEPS
            wheels.covered[2 * robot] = wheels.ground[2 * robot] * part
            wheels.covered[2 * robot + 1] = wheels.ground[2 * robot + 1] * part
        place = 6 * rows[robot]
        robots.yaw[robot] = bodies[place + 2]
        robots.velocity_x[robot] = bodies[place + 3]
        robots.velocity_y[robot] = bodies[place + 4]
        turn_rate = bodies[place + 5]
        speed = bodies[place + 3] * robots.cosine[robot] + bodies[place + 4] * robots.sine[robot]
        # Each wheel is half a track beside the center.
        half = turn_rate * _TRACK_M / 2.0
        robots.speed[robot] = speed
        robots.turn_rate[robot] = turn_rate
        wheels.covered[2 * robot] = wheels.covered[2 * robot] + (speed - half) / _SUB_STEPS
        wheels.covered[2 * robot + 1] = wheels.covered[2 * robot + 1] + (speed + half) / _SUB_STEPS


@kernel
def read_poses(robots: RobotState, wheels: WheelState, rows: Ints, bodies: Floats) -> None:
    """After a tick: read the poses; a robot that touched nothing covered what its wheels gave. See `read_motion`."""
    for robot in range(robots.count):
        if robots.is_standing[robot] == 0:
            wheels.covered[2 * robot] = wheels.ground[2 * robot]
            wheels.covered[2 * robot + 1] = wheels.ground[2 * robot + 1]
            continue
        place = 6 * rows[robot]
        robots.x[robot] = bodies[place]
        robots.y[robot] = bodies[place + 1]
        robots.yaw[robot] = bodies[place + 2]
        if robots.was_touching[robot] == 0:
            wheels.covered[2 * robot] = wheels.ground[2 * robot]
            wheels.covered[2 * robot + 1] = wheels.ground[2 * robot + 1]
