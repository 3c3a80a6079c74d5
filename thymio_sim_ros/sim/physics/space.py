"""The space of all bodies: motion, collisions, and the obstacles of rays."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
import pymunk

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc, Solid, Trigger
from thymio_sim_ros.sim.model.spatial_grid import SpatialGrid
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, Contact
from thymio_sim_ros.sim.physics.contact_tracker import ContactTracker
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.door_controller import DoorController
from thymio_sim_ros.sim.physics.movable_body import AT_REST_M_S, MovableBody
from thymio_sim_ros.sim.physics.robot_bodies import RobotBodies
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.raycast.scalar import Obstacle, Surroundings, obstacle_of

__all__ = ["Physics"]

_SLOP_M = 0.0002
"""Overlap that the solver leaves between touching bodies."""
_ITERATIONS = 40
"""Iterations of the solver; with fewer, mirrored worlds do not give mirrored motion."""
_DRAG_PER_S = 0.01
"""Part of its speed that an object loses per second, besides friction.

Source: docs/spec/playground-formats.md section 1.3.
"""
_DROWSY_S = 0.1
"""An object at rest for this long sleeps until it is touched."""


class Physics:
    """The bodies of a world. Invariant: only `step` and the placing methods move them."""

    def __init__(
        self,
        solids: Iterable[Solid],
        triggers: Iterable[Trigger] = (),
        robots: int = 1,
        *,
        solid_robots: bool = True,
    ) -> None:
        """Create the space; `robots` is the number of robots that will be added at once.

        `solid_robots`: whether robots touch each other.
        """
        self._space = pymunk.Space()
        self._space.collision_slop = _SLOP_M
        self._space.iterations = _ITERATIONS
        self._space.damping = math.exp(-_DRAG_PER_S)
        self._space.idle_speed_threshold = AT_REST_M_S
        self._space.sleep_time_threshold = _DROWSY_S
        solids = tuple(solids)
        self._contact_tracker = ContactTracker(self._space)
        self._movables: dict[str, MovableBody] = {}
        self._moved: set[MovableBody | DoorBody] = set()
        """Objects and doors that have moved since the last call of `moved_obstacles`."""
        self._door_controller = DoorController(solids, triggers, self._moved)
        for solid in solids:
            if solid.load is not None:
                self._movables[solid.name] = movable = MovableBody(solid, self._space.static_body, self._moved)
                self._add(solid.name, movable.shape, movable.body, *movable.joints)
            elif solid.slide is not None:
                door = self._door_controller.doors[solid.name]
                self._add(solid.name, door.shape, door.body)
            else:
                self._add(solid.name, self._fixed_shape(solid))
        self._numbers = {body: number for number, body in enumerate(self.objects)}
        self.fixed: tuple[Obstacle, ...] = tuple(obstacle_of(solid) for solid in solids if solid.is_fixed)
        """Obstacles that never move."""
        self._fixed_grid: SpatialGrid[Obstacle] = SpatialGrid()
        for obstacle in self.fixed:
            self._fixed_grid.add(obstacle, obstacle.bounds)
        self.robots = RobotBodies(self._space, len(self._numbers), len(solids), robots, are_solid=solid_robots)
        self._was_still = False
        self._standing: list[MovableBody] = []
        """Objects that have not fallen."""
        self._motions = np.zeros((0, 6))
        """The last values read of each of them, with the velocities that `end_tick` left."""
        self._rows: Any = ()
        """Their rows among the bodies that are read, in the order with the number `_order`."""
        self._order = -1

    @property
    def movables(self) -> Mapping[str, MovableBody]:
        """Everything that can be pushed, by name, in the order of the playground."""
        return MappingProxyType(self._movables)

    @property
    def doors(self) -> Mapping[str, DoorBody]:
        """All doors by name, in the order of the playground."""
        return self._door_controller.doors

    def movable_obstacles(self) -> list[Obstacle | None]:
        """The obstacles of `objects`, in that order; None for a fallen one."""
        self._moved.clear()
        return [_obstacle_or_none(body) for body in self.objects]

    def moved_obstacles(self) -> dict[int, Obstacle | None]:
        """The obstacles of objects that have moved since the last call of this or of `movable_obstacles`.

        The keys are indices in `objects`; None stands for an object that has fallen.
        """
        found = {self._numbers[body]: _obstacle_or_none(body) for body in self._moved}
        self._moved.clear()
        return found

    def add_robot(self, name: str, pose: Pose) -> RobotBody:
        """Add the body of a robot, at rest at a pose."""
        robot = self.robots.add(name, pose)
        self._contact_tracker.watch(robot.shape, robot)
        self._was_still = False
        return robot

    def remove_robot(self, robot: RobotBody) -> None:
        """Remove a robot's body and its contacts."""
        self._contact_tracker.unwatch(robot.shape)
        self.robots.remove(robot)
        self._was_still = False

    def take_off_floor(self, robot: RobotBody) -> None:
        """Take a robot that stands off the floor; nothing touches or sees it until it is placed."""
        self._contact_tracker.forget(robot.shape)
        self.robots.take_off_floor(robot)
        self._was_still = False

    def drop_movable(self, movable: MovableBody) -> None:
        """Make an object fall."""
        self._space.remove(movable.shape, movable.body, *movable.joints)
        self._contact_tracker.forget(movable.shape)
        movable.fall()
        self._was_still = False

    def place(self, body: RobotBody | MovableBody, pose: Pose) -> None:
        """Place a robot or an object at a pose, at rest; it stands on the floor from now on."""
        if isinstance(body, RobotBody):
            self.robots.place(body, pose)
        else:
            was_fallen = body.is_fallen
            body.place(pose)
            if was_fallen:
                self._space.add(body.body, body.shape, *body.joints)
        self._was_still = False

    @property
    def objects(self) -> tuple[MovableBody | DoorBody, ...]:
        """Movables and doors, always in the same order."""
        return (*self._movables.values(), *self.doors.values())

    def step(self) -> tuple[Contact, ...]:
        """Advance by one tick; returns the contacts at its end, by robot and in the order in which they began."""
        # Still before two steps in a row: the last step changed nothing, and this one would not either.
        was_still, self._was_still = self._was_still, self._is_still
        if was_still and self._was_still:
            return ()
        self._door_controller.begin_tick(self.robots)
        self.robots.begin_tick()
        for earlier in range(SUB_STEPS):
            self.robots.push()
            self._space.step(SUB_STEP_S)
            self.robots.finish_sub_step(earlier)
        self.robots.end_tick()
        self._read_movables()
        self._door_controller.end_tick(self._space)
        return self.robots.contacts()

    def _read_movables(self) -> None:
        """Update the objects whose motion differs from what was read last."""
        reader = self.robots.reader
        if reader.order != self._order:
            # The rows of bodies have changed. NaN differs from every value, so all objects are updated once.
            self._order = reader.order
            self._standing = [movable for movable in self._movables.values() if not movable.is_fallen]
            self._motions = np.full((len(self._standing), 6), np.nan)
            self._rows = reader.rows([movable.body for movable in self._standing])
        if not self._standing:
            return
        before, self._motions = self._motions, reader.state[self._rows]
        changed = (self._motions != before).any(axis=1)
        for number in changed.nonzero()[0].tolist():
            movable, motion = self._standing[number], self._motions[number]
            movable.end_tick(*motion.tolist())
            # An object that has come to rest has velocity 0 from now on in pymunk, too; the next comparison expects it.
            if not movable.is_moving:
                motion[3:] = 0.0

    @property
    def _is_still(self) -> bool:
        """Whether nothing has moved in the last tick and nothing will in the next."""
        return (
            self.robots.are_still
            and self._door_controller.are_still
            and not any(movable.is_moving for movable in self._movables.values())
        )

    def surroundings(self, robot: RobotBody, reach_m: float, height_m: float) -> Surroundings:
        """The obstacles within `reach_m` of a robot's origin that are at least `height_m` high.

        A robot off the floor has none. The robot itself is not among them.
        """
        if not robot.is_standing:
            return Surroundings(())
        x, y = robot.pose.x_m, robot.pose.y_m
        near = [
            obstacle
            for obstacle in self._fixed_grid.near((x - reach_m, y - reach_m, x + reach_m, y + reach_m))
            if obstacle.height_m >= height_m and obstacle.is_within(x, y, reach_m)
        ]
        bodies: list[RobotBody | MovableBody | DoorBody] = [
            *(other for other in self.robots if other.is_standing and other is not robot),
            *(thing for thing in self.objects if not thing.is_fallen),
        ]
        near += [
            body.obstacle
            for body in bodies
            if math.hypot(body.pose.x_m - x, body.pose.y_m - y) <= reach_m + body.reach_m
            and body.obstacle.height_m >= height_m
        ]
        return Surroundings(near)

    def _add(self, owner: str, shape: pymunk.Shape, *parts: pymunk.Body | pymunk.Constraint) -> None:
        self._contact_tracker.watch(shape, owner)
        self._space.add(*parts, shape)

    def _fixed_shape(self, solid: Solid) -> pymunk.Shape:
        body = self._space.static_body
        if isinstance(solid.outline, Disc):
            return pymunk.Circle(body, solid.outline.radius_m, (solid.pose.x_m, solid.pose.y_m))
        return pymunk.Poly(body, solid.vertices)


def _obstacle_or_none(body: MovableBody | DoorBody) -> Obstacle | None:
    """The obstacle of an object or door; None if it has fallen."""
    return None if body.is_fallen else body.obstacle
