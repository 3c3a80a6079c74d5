"""The space of all bodies: it lets them move and collide, and knows what rays may meet.

While nothing is in anybody's reach and nothing moves by itself, pymunk rests and the robots glide by the same sums.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType

import pymunk

from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.nearby import Mover, Nearby
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, Contact
from thymio_sim_ros.sim.physics.doors import DoorBody
from thymio_sim_ros.sim.physics.fleet import Fleet
from thymio_sim_ros.sim.physics.gates import Gates
from thymio_sim_ros.sim.physics.movables import AT_REST_M_S, MovableBody
from thymio_sim_ros.sim.physics.quiet import LOOK_ROUND_TICKS, quiet_ticks
from thymio_sim_ros.sim.physics.robots import RobotBody
from thymio_sim_ros.sim.physics.touches import Touches
from thymio_sim_ros.sim.primitives import Disc, Solid, Trigger
from thymio_sim_ros.sim.rays import Obstacle, Surroundings, obstacle_of

__all__ = ["Physics"]

_SLOP_M = 0.0002
"""Overlap that is left between touching bodies."""
_ITERATIONS = 40
"""Of the solver: with fewer, mirrored worlds do not push mirrored."""
_DRAG_PER_S = 0.01
"""Of its speed a thing loses this part each second, beside its friction (playground-formats.md section 1.3)."""
_DROWSY_S = 0.1
"""What has been at rest for so long costs nothing until it is touched."""


class Physics:
    """The bodies of a world. Invariant: only `step` and the placing methods move them."""

    def __init__(self, solids: Iterable[Solid], triggers: Iterable[Trigger] = ()) -> None:
        self._space = pymunk.Space()
        self._space.collision_slop = _SLOP_M
        self._space.iterations = _ITERATIONS
        self._space.damping = math.exp(-_DRAG_PER_S)
        self._space.idle_speed_threshold = AT_REST_M_S
        self._space.sleep_time_threshold = _DROWSY_S
        solids = tuple(solids)
        bouncing = any(solid.load is not None and solid.load.restitution for solid in solids)
        self._touches = Touches(self._space, self._tell_fleet, do_things_bounce=bouncing)
        self._robots: dict[RobotBody, None] = {}
        self._movables: dict[str, MovableBody] = {}
        self._gates = Gates(solids, triggers)
        self._fleet: Fleet | None = None
        self._quiet_ticks = 0
        self._engine_ticks = 0
        for solid in solids:
            if solid.load is not None:
                self._movables[solid.name] = movable = MovableBody(solid, self._space.static_body)
                self._add(solid.name, movable.shape, movable.body, *movable.joints)
            elif solid.slide is not None:
                door = self._gates.doors[solid.name]
                self._add(solid.name, door.shape, door.body)
            else:
                self._add(solid.name, self._fixed_shape(solid))
        self.fixed: tuple[Obstacle, ...] = tuple(obstacle_of(solid) for solid in solids if solid.is_fixed)
        """What rays see of everything that never moves."""
        self._nearby = Nearby(self.fixed)
        self._list_movers()

    @property
    def movables(self) -> Mapping[str, MovableBody]:
        """Everything that can be pushed, by name, in the order of the playground."""
        return MappingProxyType(self._movables)

    @property
    def doors(self) -> Mapping[str, DoorBody]:
        """All doors by name, in the order of the playground."""
        return self._gates.doors

    def loose(self) -> list[Obstacle | None]:
        """What rays see of movables, then of doors; None for what has fallen."""
        found = [None if movable.is_fallen else movable.obstacle for movable in self._movables.values()]
        return [*found, *(door.obstacle for door in self.doors.values())]

    def add_robot(self, name: str, pose: Pose) -> RobotBody:
        """A robot's body, at rest at a pose."""
        self.disband()
        self._interrupt()
        robot = RobotBody(name, pose)
        self._robots[robot] = None
        self._add(robot, robot.shape, robot.body)
        self._list_movers()
        return robot

    def remove_robot(self, robot: RobotBody) -> None:
        """Take a robot's body away; nobody touches it any more."""
        self.disband()
        self._interrupt()
        if not robot.is_fallen:
            self._space.remove(robot.shape, robot.body)
        self._touches.unwatch(robot.shape)
        del self._robots[robot]
        self._list_movers()

    def drop_robot(self, robot: RobotBody) -> None:
        """Let a robot fall below the floor, where nothing touches or sees it."""
        self._interrupt()
        self._space.remove(robot.shape, robot.body)
        self._touches.forget(robot.shape)
        robot.fall()
        self._list_movers()

    def drop_movable(self, movable: MovableBody) -> None:
        """Let a thing fall below the floor."""
        self._interrupt()
        self._space.remove(movable.shape, movable.body, *movable.joints)
        self._touches.forget(movable.shape)
        movable.fall()
        self._list_movers()

    def place(self, body: RobotBody | MovableBody, pose: Pose) -> None:
        """Put a robot or a thing somewhere, at rest; what has fallen stands on the floor again."""
        self._interrupt()
        was_fallen = body.is_fallen
        body.place(pose)
        if was_fallen:
            self._space.add(body.body, body.shape)
            if isinstance(body, MovableBody):
                self._space.add(*body.joints)
            self._list_movers()
        self._nearby.stir()

    @property
    def objects(self) -> tuple[MovableBody | DoorBody, ...]:
        """Movables and doors, always in the same order."""
        return (*self._movables.values(), *self.doors.values())

    def gather(self) -> Fleet:
        """All robots move as one from now on, until one is added or removed or they disband."""
        self._interrupt()
        is_alone = not self._movables and not self.doors
        self._fleet = Fleet(self._space, tuple(self._robots), tuple(self._movables.values()), is_alone=is_alone)
        return self._fleet

    def disband(self) -> None:
        """Every robot moves alone again."""
        if self._fleet is not None:
            self._fleet.disband()
            self._fleet = None

    def step(self) -> tuple[Contact, ...]:
        """One tick; the contacts at its end, by robot and in the order in which they began."""
        self._nearby.stir()
        self._gates.begin_tick(self._nearby)
        if not self._gates.are_still:
            self._stop_gliding()
        if self._quiet_ticks > 0:
            self._glide()
            return ()
        drivers: Sequence[RobotBody | Fleet] = (self._fleet,) if self._fleet is not None else self._standing()
        for driver in drivers:
            driver.begin_tick()
        for earlier in range(SUB_STEPS):
            for driver in drivers:
                driver.push()
            self._space.step(SUB_STEP_S)
            for driver in drivers:
                driver.settle(earlier)
        for driver in drivers:
            driver.end_tick()
        if self._fleet is None:
            for movable in self._movables.values():
                movable.end_tick()
        self._gates.end_tick()
        self._engine_ticks += 1
        if self._engine_ticks % LOOK_ROUND_TICKS == 0:
            self._quiet_ticks = self._count_quiet_ticks()
        touching = self._standing() if self._fleet is None else self._fleet.touching()
        return tuple(contact for robot in touching for contact in robot.touching.values())

    def surroundings(self, robot: RobotBody, reach_m: float, height_m: float) -> Surroundings:
        """What a robot's rays may meet within `reach_m` of its origin, at least `height_m` high."""
        if robot.is_fallen:
            return Surroundings(())
        x, y = robot.pose.x_m, robot.pose.y_m
        low_x, low_y, high_x, high_y = x - reach_m, y - reach_m, x + reach_m, y + reach_m
        near = []
        for obstacle in self._nearby.fixed(x, y, reach_m):
            left, bottom, right, top = obstacle.bounds
            if (
                left <= high_x and right >= low_x and bottom <= high_y and top >= low_y
                and obstacle.height_m >= height_m and obstacle.is_within(x, y, reach_m)
            ):  # fmt: skip
                near.append(obstacle)
        near.extend(
            mover.obstacle
            for mover in self._nearby.movers(x, y, reach_m)
            if mover is not robot and mover.obstacle.height_m >= height_m
        )
        return Surroundings(near)

    def _standing(self) -> list[RobotBody]:
        """Robots that have not fallen."""
        return [robot for robot in self._robots if not robot.is_fallen]

    def _glide(self) -> None:
        """A tick in which nothing can be touched."""
        for robot in self._robots:
            if not robot.is_fallen:
                robot.glide()
        self._quiet_ticks -= 1
        if self._quiet_ticks == 0:
            self._quiet_ticks = self._count_quiet_ticks()
            if self._quiet_ticks == 0:
                self._wake()

    def _interrupt(self) -> None:
        """Before a body is changed from outside."""
        self._stop_gliding()
        if self._fleet is not None:
            self._fleet.release()

    def _stop_gliding(self) -> None:
        if self._quiet_ticks > 0:
            self._quiet_ticks = 0
            self._wake()

    def _wake(self) -> None:
        """Let the engine take over."""
        for robot in self._robots:
            robot.wake()

    def _count_quiet_ticks(self) -> int:
        """For how many ticks no robot can reach anything, however it drives."""
        robots = self._standing()
        is_still = self._gates.are_still and not any(movable.is_moving for movable in self._movables.values())
        if self._fleet is not None or not is_still or any(robot.touching for robot in robots):
            return 0
        return quiet_ticks(robots, self._nearby)

    def _list_movers(self) -> None:
        """Tell `nearby` who moves now."""
        movers: list[Mover] = [*self._standing()]
        movers += [movable for movable in self._movables.values() if not movable.is_fallen]
        self._nearby.replace_movers([*movers, *self.doors.values()])

    def _add(self, owner: RobotBody | str, shape: pymunk.Shape, *parts: pymunk.Body | pymunk.Constraint) -> None:
        self._touches.watch(shape, owner)
        self._space.add(*parts, shape)

    def _fixed_shape(self, solid: Solid) -> pymunk.Shape:
        body = self._space.static_body
        if isinstance(solid.outline, Disc):
            return pymunk.Circle(body, solid.outline.radius_m, (solid.pose.x_m, solid.pose.y_m))
        return pymunk.Poly(body, solid.vertices)

    def _tell_fleet(self, robot: RobotBody) -> None:
        if self._fleet is not None:
            self._fleet.changed.add(robot)
