"""Bodies, contacts and what rays meet: the only module that knows pymunk.

Robots are dynamic bodies. A free robot has the speed of its wheels; its velocity points along the heading in the
middle of the sub-step, so that its path follows arcs to the third order. pymunk moves bodies first and solves
contacts and forces afterwards; a robot that touches something is therefore pushed by a force, which that
solution takes into account, and which is small enough that walls and heavy things stop it. Contacts are without
bounce and without friction along the wall (thymio-robot.md section 11).
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import pymunk

from thymio_sim_ros.sim import thymio2
from thymio_sim_ros.sim.clock import TICK_NS
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.primitives import Disc, Solid
from thymio_sim_ros.sim.rays import ConvexObstacle, Obstacle, Surroundings, obstacle_of

__all__ = ["Contact", "Physics", "RobotBody"]

SUB_STEPS = 2
_DT = TICK_NS * 1e-9 / SUB_STEPS
_SLOP_M = 0.0002
"""Overlap that is left between touching bodies."""
_MOMENT_KG_M2 = 1.0
"""Far above the real one: wheels hold the heading of a robot that hits a wall (thymio-robot.md section 11)."""
_PUSH_N_S_M = thymio2.DRIVE_FORCE_N / thymio2.MAX_SPEED_M_S
"""Force for each m/s that a robot in contact lacks; wheels at rest resist a push in the same way."""
_ROBOT, _SOLID = 1, 2
_HULL = thymio2.hull()
_HULL_REACH_M = thymio2.HULL_RADIUS_M


@dataclass(frozen=True, slots=True)
class Contact:
    """A robot touches a solid or another robot, named by `other`.

    `speed_m_s` is the speed of approach when the contact began; `is_new` when that was in this tick.
    """

    robot: str
    other: str
    x_m: float
    y_m: float
    speed_m_s: float
    is_new: bool


class RobotBody:
    """One robot's body. `left_m` and `right_m`: ground covered at each wheel in this tick."""

    __slots__ = (
        "_body",
        "_left_m_s",
        "_right_m_s",
        "_shape",
        "_speed",
        "_spin",
        "left_m",
        "name",
        "pose",
        "right_m",
        "touching",
    )

    def __init__(self, name: str, pose: Pose) -> None:
        self.name = name
        self.pose = pose
        self.touching: dict[object, Contact] = {}
        self.left_m = self.right_m = 0.0
        self._left_m_s = self._right_m_s = self._speed = self._spin = 0.0
        self._body = pymunk.Body(thymio2.MASS_KG, _MOMENT_KG_M2)
        self._body.position = (pose.x_m, pose.y_m)
        self._body.angle = pose.yaw_rad
        self._shape = pymunk.Poly(self._body, _HULL)
        self._shape.collision_type = _ROBOT

    @property
    def speed_m_s(self) -> float:
        """Speed along the heading."""
        return self._speed

    @property
    def spin_rad_s(self) -> float:
        """Rate of turn, counter-clockwise."""
        return self._spin

    def drive(self, left_m_s: float, right_m_s: float) -> None:
        """Ground speed that each wheel gives from now on."""
        self._left_m_s, self._right_m_s = left_m_s, right_m_s

    def place(self, pose: Pose) -> None:
        """Put it somewhere, at rest."""
        body = self._body
        body.position, body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
        self._speed = self._spin = 0.0
        self.pose = pose
        if body.space is not None:
            body.space.reindex_shapes_for_body(body)

    def _push(self) -> float:
        """Take the speed of the wheels, as far as contacts let; the heading in the middle of the movement."""
        body = self._body
        speed = (self._left_m_s + self._right_m_s) / 2
        spin = (self._right_m_s - self._left_m_s) / thymio2.WHEEL_TRACK_M
        if self.touching:
            return self._press(speed, spin)
        heading = body.angle + spin / 2 * _DT
        body.velocity = (speed * math.cos(heading), speed * math.sin(heading))
        body.angular_velocity = spin
        return heading

    def _press(self, speed: float, spin: float) -> float:
        """Push against what is touched: the more speed is missing, the harder."""
        body = self._body
        heading = body.angle + (body.angular_velocity + spin / 2) * _DT
        vx, vy = body.velocity
        body.force = (
            (speed * math.cos(heading) - vx) * _PUSH_N_S_M,
            (speed * math.sin(heading) - vy) * _PUSH_N_S_M,
        )
        body.torque = (spin - body.angular_velocity) * (_MOMENT_KG_M2 / _DT)
        return heading

    def _read(self, heading: float) -> None:
        """Take over what the sub-step has made of the push."""
        body = self._body
        vx, vy = body.velocity
        self._speed = vx * math.cos(heading) + vy * math.sin(heading)
        self._spin = body.angular_velocity
        half = self._spin * thymio2.WHEEL_TRACK_M / 2
        self.left_m += (self._speed - half) * _DT
        self.right_m += (self._speed + half) * _DT
        x_m, y_m = body.position
        self.pose = Pose(x_m, y_m, body.angle)


class Physics:
    """The bodies of a world. Invariant: only `step` and `RobotBody.place` move them."""

    def __init__(self, solids: Iterable[Solid]) -> None:
        self._space = pymunk.Space()
        self._space.collision_slop = _SLOP_M
        self._names: dict[pymunk.Shape, str] = {}
        self._robots: list[RobotBody] = []
        self._by_shape: dict[pymunk.Shape, RobotBody] = {}
        self._static: list[tuple[float, float, float, float, Obstacle]] = []
        for solid in solids:
            self._add_solid(solid)
        for other in (_ROBOT, _SOLID):
            self._space.on_collision(_ROBOT, other, begin=self._on_begin, separate=self._on_separate)

    def add_robot(self, name: str, pose: Pose) -> RobotBody:
        """A robot's body, at rest at a pose."""
        robot = RobotBody(name, pose)
        self._robots.append(robot)
        self._names[robot._shape] = name
        self._by_shape[robot._shape] = robot
        self._space.add(robot._body, robot._shape)
        return robot

    def step(self) -> tuple[Contact, ...]:
        """One tick; the contacts at its end, by robot and in the order in which they began."""
        robots = self._robots
        for robot in robots:
            robot.left_m = robot.right_m = 0.0
            if robot.touching:
                self._age(robot)
        for _ in range(SUB_STEPS):
            headings = [robot._push() for robot in robots]
            self._space.step(_DT)
            for robot, heading in zip(robots, headings, strict=True):
                robot._read(heading)
        return tuple(contact for robot in robots for contact in robot.touching.values())

    def surroundings(self, robot: RobotBody, reach_m: float, height_m: float) -> Surroundings:
        """What a robot's rays may meet within `reach_m` of its origin, at least `height_m` high."""
        x, y = robot.pose.x_m, robot.pose.y_m
        low_x, low_y, high_x, high_y = x - reach_m, y - reach_m, x + reach_m, y + reach_m
        near = [
            obstacle
            for left, bottom, right, top, obstacle in self._static
            if left <= high_x and right >= low_x and bottom <= high_y and top >= low_y
            and obstacle.height_m >= height_m and obstacle.is_within(x, y, reach_m)
        ]  # fmt: skip
        if height_m <= thymio2.HULL_HEIGHT_M:
            limit = reach_m + _HULL_REACH_M
            near.extend(
                ConvexObstacle(other.pose.place_all(_HULL), thymio2.HULL_HEIGHT_M)
                for other in self._robots
                if other is not robot and math.hypot(other.pose.x_m - x, other.pose.y_m - y) <= limit
            )
        return Surroundings(near)

    def _add_solid(self, solid: Solid) -> None:
        obstacle = obstacle_of(solid)
        self._static.append((*obstacle.bounds, obstacle))
        body = self._space.static_body
        shape: pymunk.Shape
        if isinstance(solid.outline, Disc):
            shape = pymunk.Circle(body, solid.outline.radius_m, (solid.pose.x_m, solid.pose.y_m))
        else:
            shape = pymunk.Poly(body, solid.vertices)
        shape.collision_type = _SOLID
        self._names[shape] = solid.name
        self._space.add(shape)

    def _age(self, robot: RobotBody) -> None:
        for key, old in robot.touching.items():
            if old.is_new:
                robot.touching[key] = Contact(old.robot, old.other, old.x_m, old.y_m, old.speed_m_s, False)

    def _on_begin(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        one, other = arbiter.shapes
        points = arbiter.contact_point_set
        x, y = points.points[0].point_a
        speed = max(0.0, (_velocity(one, (x, y)) - _velocity(other, (x, y))).dot(points.normal))
        for mine, its in ((one, other), (other, one)):
            robot = self._by_shape.get(mine)
            if robot is not None:
                robot.touching[its] = Contact(robot.name, self._names[its], x, y, speed, True)

    def _on_separate(self, arbiter: pymunk.Arbiter, _space: pymunk.Space, _data: Any) -> None:
        one, other = arbiter.shapes
        for mine, its in ((one, other), (other, one)):
            robot = self._by_shape.get(mine)
            if robot is not None:
                robot.touching.pop(its, None)


def _velocity(shape: pymunk.Shape, point: tuple[float, float]) -> pymunk.Vec2d:
    """Of a shape's body where it is touched."""
    assert shape.body is not None
    return shape.body.velocity_at_world_point(point)
