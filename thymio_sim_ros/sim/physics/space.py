"""The space of all bodies: motion, collisions, and the obstacles of rays.

Robots that can reach nothing are not in pymunk's space but are integrated by the same formulas. While that holds for
all robots and no object or door moves, pymunk does not step.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from types import MappingProxyType

import pymunk

from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc, Solid, Trigger
from thymio_sim_ros.sim.physics.batch_driver import BatchDriver
from thymio_sim_ros.sim.physics.broadphase_batch import BroadphaseBatch
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS, Contact
from thymio_sim_ros.sim.physics.contact_tracker import ContactTracker
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.door_controller import DoorController
from thymio_sim_ros.sim.physics.movable_body import AT_REST_M_S, MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.scalar_driver import ScalarDriver
from thymio_sim_ros.sim.raycast.broadphase import Broadphase, Mover
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

    def __init__(self, solids: Iterable[Solid], triggers: Iterable[Trigger] = ()) -> None:
        self._space = pymunk.Space()
        self._space.collision_slop = _SLOP_M
        self._space.iterations = _ITERATIONS
        self._space.damping = math.exp(-_DRAG_PER_S)
        self._space.idle_speed_threshold = AT_REST_M_S
        self._space.sleep_time_threshold = _DROWSY_S
        solids = tuple(solids)
        bouncing = any(solid.load is not None and solid.load.restitution for solid in solids)
        self._contact_tracker = ContactTracker(self._space, self._mark_changed, do_objects_bounce=bouncing)
        self._robots: dict[RobotBody, None] = {}
        self._movables: dict[str, MovableBody] = {}
        self._moved: set[MovableBody | DoorBody] = set()
        """Objects and doors that have moved since the last call of `moved_obstacles`."""
        self._door_controller = DoorController(solids, triggers, self._moved)
        self._batch_driver: BatchDriver | None = None
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
        self._broadphase = Broadphase(self.fixed)
        self._list_movers()
        self._scalar_driver = ScalarDriver(self._space, self._robots, self._movables, self._broadphase)

    @property
    def movables(self) -> Mapping[str, MovableBody]:
        """Everything that can be pushed, by name, in the order of the playground."""
        return MappingProxyType(self._movables)

    @property
    def doors(self) -> Mapping[str, DoorBody]:
        """All doors by name, in the order of the playground."""
        return self._door_controller.doors

    def movable_obstacles(self) -> list[Obstacle | None]:
        """Return the obstacles of `objects`, in that order; None for a fallen one."""
        self._moved.clear()
        return [_obstacle_or_none(body) for body in self.objects]

    def moved_obstacles(self) -> dict[int, Obstacle | None]:
        """Return the obstacles of objects that have moved since the last call of this or of `movable_obstacles`.

        The keys are indices in `objects`; None stands for an object that has fallen.
        """
        found = {self._numbers[body]: _obstacle_or_none(body) for body in self._moved}
        self._moved.clear()
        return found

    def add_robot(self, name: str, pose: Pose) -> RobotBody:
        """Add the body of a robot, at rest at a pose; ends the batch."""
        self.dissolve()
        self._interrupt()
        robot = RobotBody(name, pose)
        self._robots[robot] = None
        self._contact_tracker.watch(robot.shape, robot)
        self._list_movers()
        return robot

    def remove_robot(self, robot: RobotBody) -> None:
        """Remove a robot's body and its contacts; ends the batch. Raises KeyError for a body that is not here."""
        self.dissolve()
        self._interrupt()
        robot.deactivate(self._space)
        self._contact_tracker.unwatch(robot.shape)
        del self._robots[robot]
        self._list_movers()

    def drop_robot(self, robot: RobotBody) -> None:
        """Make a robot fall; nothing touches or sees it until it is placed."""
        self._interrupt()
        robot.deactivate(self._space)
        self._contact_tracker.forget(robot.shape)
        robot.fall()
        self._list_movers()

    def drop_movable(self, movable: MovableBody) -> None:
        """Make an object fall."""
        self._interrupt()
        self._space.remove(movable.shape, movable.body, *movable.joints)
        self._contact_tracker.forget(movable.shape)
        movable.fall()
        self._list_movers()

    def place(self, body: RobotBody | MovableBody, pose: Pose) -> None:
        """Place a robot or an object at a pose, at rest; a fallen one stands on the floor again."""
        self._interrupt()
        was_fallen = body.is_fallen
        body.place(pose)
        if was_fallen:
            if isinstance(body, MovableBody):
                self._space.add(body.body, body.shape, *body.joints)
            self._list_movers()
        self._broadphase.invalidate_movers()

    @property
    def objects(self) -> tuple[MovableBody | DoorBody, ...]:
        """Movables and doors, always in the same order."""
        return (*self._movables.values(), *self.doors.values())

    def form_batch(self) -> BatchDriver:
        """Move all robots as a batch until a robot is added or removed or `dissolve` is called."""
        self._interrupt()
        movables, doors = tuple(self._movables.values()), tuple(self.doors.values())
        self._batch_driver = BatchDriver(self._space, tuple(self._robots), movables, doors, BroadphaseBatch(self.fixed))
        return self._batch_driver

    def dissolve(self) -> None:
        """End the batch: robots are moved one by one again."""
        if self._batch_driver is not None:
            self._batch_driver.dissolve()
            self._batch_driver = None
            self._scalar_driver.interrupt()

    def step(self) -> tuple[Contact, ...]:
        """Step by one tick; returns the contacts at its end, by robot and in the order in which they began."""
        self._broadphase.invalidate_movers()
        self._door_controller.begin_tick(self._broadphase)
        driver = self._batch_driver or self._scalar_driver
        driver.begin_tick(do_doors_move=not self._door_controller.are_still)
        if driver.needs_engine:
            for earlier in range(SUB_STEPS):
                driver.push()
                self._space.step(SUB_STEP_S)
                driver.finish_sub_step(earlier)
            driver.end_tick()
        self._door_controller.end_tick(self._space)
        return driver.contacts()

    def surroundings(self, robot: RobotBody, reach_m: float, height_m: float) -> Surroundings:
        """Return the obstacles within `reach_m` of a robot's origin that are at least `height_m` high.

        A fallen robot has none. The robot itself is not among them.
        """
        if robot.is_fallen:
            return Surroundings(())
        x, y = robot.pose.x_m, robot.pose.y_m
        low_x, low_y, high_x, high_y = x - reach_m, y - reach_m, x + reach_m, y + reach_m
        near = []
        # First the bounds, which are cheap, then the exact test.
        for obstacle in self._broadphase.fixed(x, y, reach_m):
            left, bottom, right, top = obstacle.bounds
            if (
                left <= high_x and right >= low_x and bottom <= high_y and top >= low_y
                and obstacle.height_m >= height_m and obstacle.is_within(x, y, reach_m)
            ):  # fmt: skip
                near.append(obstacle)
        near.extend(
            mover.obstacle
            for mover in self._broadphase.movers(x, y, reach_m)
            if mover is not robot and mover.obstacle.height_m >= height_m
        )
        return Surroundings(near)

    def _standing(self) -> list[RobotBody]:
        """Return the robots that have not fallen."""
        return [robot for robot in self._robots if not robot.is_fallen]

    def _interrupt(self) -> None:
        """Prepare for a change of a body from outside."""
        self._scalar_driver.interrupt()
        if self._batch_driver is not None:
            self._batch_driver.release()

    def _list_movers(self) -> None:
        """Update the list of moving bodies in the broadphase."""
        movers: list[Mover] = [*self._standing()]
        movers += [movable for movable in self._movables.values() if not movable.is_fallen]
        self._broadphase.replace_movers([*movers, *self.doors.values()])

    def _add(self, owner: str, shape: pymunk.Shape, *parts: pymunk.Body | pymunk.Constraint) -> None:
        self._contact_tracker.watch(shape, owner)
        self._space.add(*parts, shape)

    def _fixed_shape(self, solid: Solid) -> pymunk.Shape:
        body = self._space.static_body
        if isinstance(solid.outline, Disc):
            return pymunk.Circle(body, solid.outline.radius_m, (solid.pose.x_m, solid.pose.y_m))
        return pymunk.Poly(body, solid.vertices)

    def _mark_changed(self, robot: RobotBody) -> None:
        if self._batch_driver is not None:
            self._batch_driver.changed.add(robot)


def _obstacle_or_none(body: MovableBody | DoorBody) -> Obstacle | None:
    """Return the obstacle of an object or door; None if it has fallen."""
    return None if body.is_fallen else body.obstacle
