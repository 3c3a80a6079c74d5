"""Bodies, contacts and what rays meet: the only module that knows pymunk.

Robots are dynamic bodies. A free robot has the speed of its wheels; its velocity points along the heading in the
middle of the sub-step, so that its path follows arcs to the third order. pymunk moves bodies first and solves
contacts and forces afterwards; a robot that touches something is therefore pushed by a force, which that
solution takes into account, and which is small enough that walls and heavy things stop it. Contacts are without
bounce and without friction along the wall (thymio-robot.md section 11). While nothing is in reach, the engine rests
and the robots glide by the same sums.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
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
_LONGEST_WAY_M = thymio2.MAX_SPEED_M_S * TICK_NS * 1e-9
_SAFE_M = 0.005
_LOOK_ROUND_TICKS = 10
_MOST_GLIDING = 8
"""With more robots, looking round costs more than the engine."""
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
    """One robot's body, pushed by its two wheels. Invariant: `pose` is the body's after the last tick."""

    __slots__ = (
        "_angle",
        "_body",
        "_covered",
        "_driven",
        "_heading",
        "_is_free",
        "_shape",
        "name",
        "pose",
        "speed_m_s",
        "spin_rad_s",
        "touching",
    )

    def __init__(self, name: str, pose: Pose) -> None:
        self.name = name
        self.pose = pose
        self.touching: dict[pymunk.Shape, Contact] = {}
        self.speed_m_s = 0.0
        """Speed along the heading."""
        self.spin_rad_s = 0.0
        """Rate of turn, counter-clockwise."""
        self._driven = self._covered = (0.0, 0.0)
        self._is_free = True
        self._angle = self._heading = pose.yaw_rad
        self._body = pymunk.Body(thymio2.MASS_KG, _MOMENT_KG_M2)
        self._body.position = (pose.x_m, pose.y_m)
        self._body.angle = pose.yaw_rad
        self._shape = pymunk.Poly(self._body, _HULL)
        self._shape.collision_type = _ROBOT

    @property
    def covered_m_s(self) -> tuple[float, float]:
        """Speed over ground at each wheel, mean of the last tick; exactly what was driven when nothing was touched."""
        return self._driven if self._is_free else self._covered

    def drive(self, ground_m_s: tuple[float, float]) -> None:
        """Speed over ground that each wheel gives from now on."""
        self._driven = ground_m_s

    def place(self, pose: Pose) -> None:
        """Put it somewhere, at rest."""
        body = self._body
        body.position, body.angle = (pose.x_m, pose.y_m), pose.yaw_rad
        body.velocity, body.angular_velocity = (0.0, 0.0), 0.0
        self.speed_m_s = self.spin_rad_s = 0.0
        self._angle = pose.yaw_rad
        self.pose = pose
        if body.space is not None:
            body.space.reindex_shapes_for_body(body)

    def glide(self) -> None:
        """A tick without the engine, for when nothing can be touched; the same sums in the same order."""
        left, right = self._driven
        self.speed_m_s = speed = (left + right) / 2
        self.spin_rad_s = spin = (right - left) / thymio2.WHEEL_TRACK_M
        self._is_free = True
        x_m, y_m, angle = self.pose.x_m, self.pose.y_m, self.pose.yaw_rad
        for _ in range(SUB_STEPS):
            heading = angle + spin / 2 * _DT
            x_m += speed * math.cos(heading) * _DT
            y_m += speed * math.sin(heading) * _DT
            angle += spin * _DT
        self._angle = angle
        self.pose = Pose(x_m, y_m, angle)

    def wake(self) -> None:
        """Hand the pose over to the engine after gliding."""
        self._body.position = (self.pose.x_m, self.pose.y_m)
        self._body.angle = self._angle

    def begin_tick(self) -> None:
        """Forget what the last tick covered; contacts are no longer new."""
        self._covered = (0.0, 0.0)
        self._is_free = not self.touching
        for key, contact in self.touching.items():
            if contact.is_new:
                self.touching[key] = replace(contact, is_new=False)

    def push(self) -> None:
        """Before a sub-step: take the speed of the wheels, as far as contacts let."""
        left, right = self._driven
        speed, spin = (left + right) / 2, (right - left) / thymio2.WHEEL_TRACK_M
        body = self._body
        if not self.touching:
            self._heading = heading = self._angle + spin / 2 * _DT
            body.velocity = (speed * math.cos(heading), speed * math.sin(heading))
            body.angular_velocity = spin
            self.speed_m_s, self.spin_rad_s = speed, spin
            return
        turning = body.angular_velocity
        self._heading = heading = self._angle + (turning + spin / 2) * _DT
        vx, vy = body.velocity
        body.force = (
            (speed * math.cos(heading) - vx) * _PUSH_N_S_M,
            (speed * math.sin(heading) - vy) * _PUSH_N_S_M,
        )
        body.torque = (spin - turning) * (_MOMENT_KG_M2 / _DT)

    def settle(self, earlier: int) -> None:
        """After a sub-step, `earlier` ones done: take over what contacts have made of the push."""
        if self._is_free and not self.touching:
            self._angle += self.spin_rad_s * _DT
            return
        body = self._body
        if self._is_free:
            self._is_free = False
            left, right = self._driven
            self._covered = (left * earlier / SUB_STEPS, right * earlier / SUB_STEPS)
        vx, vy = body.velocity
        self._angle = body.angle
        self.speed_m_s = vx * math.cos(self._heading) + vy * math.sin(self._heading)
        self.spin_rad_s = body.angular_velocity
        half = self.spin_rad_s * thymio2.WHEEL_TRACK_M / 2
        left, right = self._covered
        self._covered = (
            left + (self.speed_m_s - half) / SUB_STEPS,
            right + (self.speed_m_s + half) / SUB_STEPS,
        )

    def end_tick(self) -> None:
        """Tell the new pose."""
        x_m, y_m = self._body.position
        self._angle = self._body.angle
        self.pose = Pose(x_m, y_m, self._angle)


class Physics:
    """The bodies of a world. Invariant: only `step` and `place` move them."""

    def __init__(self, solids: Iterable[Solid]) -> None:
        self._space = pymunk.Space()
        self._space.collision_slop = _SLOP_M
        self._names: dict[pymunk.Shape, str] = {}
        self._robots: list[RobotBody] = []
        self._by_shape: dict[pymunk.Shape, RobotBody] = {}
        self._static: list[tuple[float, float, float, float, Obstacle]] = []
        self._quiet_ticks = 0
        self._engine_ticks = 0
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
        if self._quiet_ticks > 0:
            self._glide()
            return ()
        robots = self._robots
        for robot in robots:
            robot.begin_tick()
        for earlier in range(SUB_STEPS):
            for robot in robots:
                robot.push()
            self._space.step(_DT)
            for robot in robots:
                robot.settle(earlier)
        for robot in robots:
            robot.end_tick()
        self._engine_ticks += 1
        if self._engine_ticks % _LOOK_ROUND_TICKS == 0:
            self._quiet_ticks = self._count_quiet_ticks()
        return tuple(contact for robot in robots for contact in robot.touching.values())

    def place(self, robot: RobotBody, pose: Pose) -> None:
        """Put a robot somewhere, at rest."""
        if self._quiet_ticks > 0:
            self._quiet_ticks = 0
            self._wake()
        robot.place(pose)

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

    def _glide(self) -> None:
        """A tick in which nothing can be touched."""
        for robot in self._robots:
            robot.glide()
        self._quiet_ticks -= 1
        if self._quiet_ticks == 0:
            self._quiet_ticks = self._count_quiet_ticks()
            if self._quiet_ticks == 0:
                self._wake()

    def _wake(self) -> None:
        """Let the engine take over."""
        for robot in self._robots:
            robot.wake()

    def _count_quiet_ticks(self) -> int:
        """For how many ticks no robot can reach anything, however it drives."""
        if len(self._robots) > _MOST_GLIDING or any(robot.touching for robot in self._robots):
            return 0
        free_m = math.inf
        for index, robot in enumerate(self._robots):
            x, y = robot.pose.x_m, robot.pose.y_m
            for left, bottom, right, top, _ in self._static:
                free_m = min(free_m, math.hypot(max(left - x, 0.0, x - right), max(bottom - y, 0.0, y - top)))
            for other in self._robots[:index]:
                free_m = min(free_m, math.hypot(other.pose.x_m - x, other.pose.y_m - y) / 2)
        ticks = (free_m - _HULL_REACH_M - _SAFE_M) / _LONGEST_WAY_M
        return max(0, int(min(ticks, _LOOK_ROUND_TICKS * 10)))

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
