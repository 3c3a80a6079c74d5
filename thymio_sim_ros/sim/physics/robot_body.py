"""The body of a robot.

A free robot has the speed of its wheels; its velocity points along the heading in the middle of the sub-step, so that
its path follows arcs to the third order. pymunk moves bodies first and solves contacts and forces afterwards; a robot
that touches something is therefore pushed by a force, which that solution takes into account: it would give the robot
the speed of its wheels within a tick, as Enki imposes, but never exceeds the grip of the tires, so that heavy
objects stall it. Wheels at rest resist a push in the same way, and two robots share the difference of their
speeds. Wheels hold the heading (docs/spec/thymio-robot.md section 11).
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Protocol

import pymunk

from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.sim.physics.contact import ROBOT_BOUNCE, SUB_STEP_S, SUB_STEPS, TICK_S, Contact
from thymio_sim_ros.sim.raycast.scalar import ConvexObstacle

__all__ = ["MOMENT_KG_M2", "PUSH_N_S_M", "ROBOT_TYPE", "BodyArrays", "RobotBody"]

ROBOT_TYPE = 1
"""pymunk's collision type of robots."""
MOMENT_KG_M2 = 1.0
"""Far above the real one: wheels hold the heading of a robot that hits a wall.

Source: docs/spec/thymio-robot.md section 11.
"""
PUSH_N_S_M = robot_constants.MASS_KG / TICK_S
"""Force for each m/s that a robot in contact lacks: enough to make up for it in one tick."""
_AT_REST_M_S = 1e-6
_HULL = robot_constants.hull()
_set_velocity, _set_spin, _set_force, _set_torque = (
    getattr(pymunk.Body, name).fset for name in ("velocity", "angular_velocity", "force", "torque")
)
"""pymunk's own setters, without its check of the attribute's name, which takes half of the time."""


class BodyArrays(Protocol):
    """The owner of the state of many robots in arrays."""

    @property
    def is_written_back(self) -> bool:
        """Whether the bodies are up to date."""
        ...

    def write_back(self) -> None:
        """Write the arrays back to the bodies."""
        ...


class RobotBody:
    """One robot's body, driven by its two wheels. Invariant: `pose` is that of the body after the last tick.

    A tick is `move_freely` for a robot that can touch nothing; else `begin_tick`, then for each sub-step `push`, a step
    of pymunk and `finish_sub_step`, then `end_tick`. In a batch the driver moves the robot, and these methods are not
    called.
    """

    __slots__ = (
        "_angle",
        "_covered",
        "_driven",
        "_heading",
        "_is_free",
        "_obstacle",
        "_pose",
        "_speed_m_s",
        "_spin_rad_s",
        "batch_driver",
        "body",
        "is_active",
        "is_fallen",
        "name",
        "shape",
        "touching",
    )

    def __init__(self, name: str, pose: Pose) -> None:
        self.name = name
        self._pose = pose
        self.touching: dict[pymunk.Shape, Contact] = {}
        self._speed_m_s = self._spin_rad_s = 0.0
        self.batch_driver: BodyArrays | None = None
        """The driver of its batch, if it is in one."""
        self.is_active = False
        """Whether pymunk moves it; otherwise its body is in no space."""
        self.is_fallen = False
        """Whether it has fallen; nothing touches or sees it until it is placed."""
        self._driven = self._covered = (0.0, 0.0)
        self._is_free = True
        self._angle = self._heading = pose.yaw_rad
        self._obstacle: tuple[Pose, ConvexObstacle] | None = None
        self.body = pymunk.Body(robot_constants.MASS_KG, MOMENT_KG_M2)
        self.body.position = (pose.x_m, pose.y_m)
        self.body.angle = pose.yaw_rad
        self.shape = pymunk.Poly(self.body, _HULL)
        self.shape.collision_type = ROBOT_TYPE
        self.shape.elasticity = ROBOT_BOUNCE

    @property
    def pose(self) -> Pose:
        """Pose in the world's frame."""
        if self.batch_driver is not None and not self.batch_driver.is_written_back:
            self.batch_driver.write_back()
        return self._pose

    @property
    def speed_m_s(self) -> float:
        """Speed along the heading in m/s."""
        if self.batch_driver is not None and not self.batch_driver.is_written_back:
            self.batch_driver.write_back()
        return self._speed_m_s

    @property
    def spin_rad_s(self) -> float:
        """Rate of turn in rad/s, counter-clockwise."""
        if self.batch_driver is not None and not self.batch_driver.is_written_back:
            self.batch_driver.write_back()
        return self._spin_rad_s

    @property
    def covered_m_s(self) -> tuple[float, float]:
        """Speed over ground in m/s at the left and right wheel, mean of the last tick.

        If nothing was touched, it is exactly the speed that was driven.
        """
        return self._driven if self._is_free else self._covered

    @property
    def reach_m(self) -> float:
        """Largest distance in m of any of its points from its origin."""
        return robot_constants.HULL_RADIUS_M

    @property
    def obstacle(self) -> ConvexObstacle:
        """The obstacle that rays of other robots see."""
        pose = self.pose
        if self._obstacle is None or self._obstacle[0] is not pose:
            self._obstacle = (pose, ConvexObstacle(pose.place_all(_HULL), robot_constants.HULL_HEIGHT_M))
        return self._obstacle[1]

    @property
    def course_rad(self) -> float:
        """Direction of motion in rad in the robot's frame, -π to π; 0 at rest."""
        if self.batch_driver is not None and not self.batch_driver.is_written_back:
            self.batch_driver.write_back()
        if self._is_free:
            return math.pi if self.speed_m_s < 0.0 else 0.0
        vx, vy = self.body.velocity
        return wrap_angle(math.atan2(vy, vx) - self._angle) if math.hypot(vx, vy) > _AT_REST_M_S else 0.0

    def drive(self, ground_m_s: tuple[float, float]) -> None:
        """Set the speed over ground in m/s of the left and right wheel from now on."""
        self._driven = ground_m_s

    def place(self, pose: Pose) -> None:
        """Move it to a pose, at rest; a fallen robot stands on the floor again."""
        self.is_fallen = False
        body = self.body
        body.position, body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
        self._speed_m_s = self._spin_rad_s = 0.0
        self._angle = pose.yaw_rad
        self._pose = pose
        if self.is_active:
            assert body.space is not None
            body.space.reindex_shapes_for_body(body)

    def set_state(self, pose: Pose, speed_m_s: float, spin_rad_s: float, *, is_free: bool) -> None:
        """Set the state that the batch driver computed."""
        self._is_free = is_free
        self._pose, self._angle = pose, pose.yaw_rad
        self._speed_m_s, self._spin_rad_s = speed_m_s, spin_rad_s

    def fall(self) -> None:
        """Fall: the wheels have no grip from now on, until `place`."""
        self.is_fallen = self._is_free = True
        self.touching.clear()
        self._speed_m_s = self._spin_rad_s = 0.0

    def move_freely(self) -> None:
        """Integrate a tick without pymunk, for a robot that can touch nothing.

        Each sub-step moves along the heading in its middle: a chord of the arc, whose error per step is of third order.
        The operations and their order are those of `push`, pymunk and `finish_sub_step`, so that the path has the same
        bits whether pymunk moves the robot or not.
        """
        left, right = self._driven
        self._speed_m_s = speed = (left + right) / 2
        self._spin_rad_s = spin = (right - left) / robot_constants.WHEEL_TRACK_M
        self._is_free = True
        x_m, y_m, angle = self._pose.x_m, self._pose.y_m, self._pose.yaw_rad
        for _ in range(SUB_STEPS):
            heading = angle + spin / 2 * SUB_STEP_S
            x_m += speed * math.cos(heading) * SUB_STEP_S
            y_m += speed * math.sin(heading) * SUB_STEP_S
            angle += spin * SUB_STEP_S
        self._angle = angle
        self._pose = Pose(x_m, y_m, angle)

    def activate(self, space: pymunk.Space) -> None:
        """Add the body to pymunk's space."""
        if not self.is_active:
            self.is_active = True
            self.body.position = (self._pose.x_m, self._pose.y_m)
            self.body.angle = self._angle
            space.add(self.body, self.shape)

    def deactivate(self, space: pymunk.Space) -> None:
        """Remove the body from pymunk's space."""
        if self.is_active:
            self.is_active = False
            space.remove(self.shape, self.body)

    def begin_tick(self) -> None:
        """Start a tick: nothing is covered yet, and contacts are no longer new."""
        self._covered = (0.0, 0.0)
        self._is_free = not self.touching
        for key, contact in self.touching.items():
            if contact.is_new:
                self.touching[key] = replace(contact, is_new=False)

    def push(self) -> None:
        """Before a sub-step: set the velocity of the wheels, or in contact a force toward it, limited by the grip."""
        left, right = self._driven
        speed, spin = (left + right) / 2, (right - left) / robot_constants.WHEEL_TRACK_M
        body = self.body
        if not self.touching:
            self._heading = heading = self._angle + spin / 2 * SUB_STEP_S
            _set_velocity(body, (speed * math.cos(heading), speed * math.sin(heading)))
            _set_spin(body, spin)
            self._speed_m_s, self._spin_rad_s = speed, spin
            return
        # pymunk integrates the velocity of the last sub-step first, so the body turns by `turning` before this force
        # acts; the heading in the middle of the sub-step after that is where the wheels will point.
        turning = body.angular_velocity
        self._heading = heading = self._angle + (turning + spin / 2) * SUB_STEP_S
        vx, vy = body.velocity
        push_x = (speed * math.cos(heading) - vx) * PUSH_N_S_M
        push_y = (speed * math.sin(heading) - vy) * PUSH_N_S_M
        # Scale the force down to the grip of the tires where it is larger, in its own direction.
        share = robot_constants.DRIVE_FORCE_N / max(robot_constants.DRIVE_FORCE_N, math.hypot(push_x, push_y))
        _set_force(body, (push_x * share, push_y * share))
        # The torque is not limited: with the large moment of inertia, wheels hold the heading.
        _set_torque(body, (spin - turning) * (MOMENT_KG_M2 / SUB_STEP_S))

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the motion that contacts allowed."""
        if self._is_free and not self.touching:
            self._angle += self._spin_rad_s * SUB_STEP_S
            return
        body = self.body
        if self._is_free:
            # The contact began in this sub-step: the earlier ones of the tick were free, at the speed of the wheels.
            self._is_free = False
            left, right = self._driven
            self._covered = (left * earlier / SUB_STEPS, right * earlier / SUB_STEPS)
        vx, vy = body.velocity
        self._angle = body.angle
        self._speed_m_s = vx * math.cos(self._heading) + vy * math.sin(self._heading)
        self._spin_rad_s = body.angular_velocity
        # Each wheel is half a track beside the center: add its speed over ground to the mean of the tick.
        half = self._spin_rad_s * robot_constants.WHEEL_TRACK_M / 2
        left, right = self._covered
        self._covered = (
            left + (self._speed_m_s - half) / SUB_STEPS,
            right + (self._speed_m_s + half) / SUB_STEPS,
        )

    def end_tick(self) -> None:
        """Update the pose."""
        x_m, y_m = self.body.position
        self._angle = self.body.angle
        self._pose = Pose(x_m, y_m, self._angle)
