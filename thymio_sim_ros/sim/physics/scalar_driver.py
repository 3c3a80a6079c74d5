"""Moves the robots of a space one by one: outside pymunk while they can reach nothing, else by pymunk."""

from __future__ import annotations

from collections.abc import Mapping

import pymunk

from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.time_to_contact import ticks_to_contact
from thymio_sim_ros.sim.raycast.broadphase import Broadphase

__all__ = ["ScalarDriver"]

_CHECK_INTERVAL_TICKS = 10
"""Interval at which active robots are checked, and the time without contact after which they are deactivated."""


class ScalarDriver:
    """Moves robots one by one: the calls of a tick are `begin_tick`, then for each sub-step `push` and
    `finish_sub_step`, then `end_tick`; the last three only if `needs_engine`.
    """

    def __init__(
        self,
        space: pymunk.Space,
        robots: Mapping[RobotBody, None],
        movables: Mapping[str, MovableBody],
        broadphase: Broadphase,
    ) -> None:
        """Drive `robots`, which may change between ticks; fallen robots do not move."""
        self._space, self._robots, self._movables, self._broadphase = space, robots, movables, broadphase
        self._active: list[RobotBody] = []
        self._is_anything_moving = False
        self._free_ticks: dict[RobotBody, int] = {}
        """Above 0: ticks in which a robot can reach nothing. Below 0: minus the ticks until an active robot is checked
        again. 0 or missing: it is checked in the next tick."""

    @property
    def needs_engine(self) -> bool:
        """Whether pymunk has to step in this tick."""
        return self._is_anything_moving or bool(self._active)

    def interrupt(self) -> None:
        """Discard cached times: a body may have been moved or removed."""
        self._free_ticks.clear()

    def begin_tick(self, *, do_doors_move: bool) -> None:
        """Integrate the robots that can reach nothing; activate the others."""
        moving = [movable for movable in self._movables.values() if movable.is_moving]
        is_unpredictable = do_doors_move or any(movable.is_fast for movable in moving)
        self._is_anything_moving = do_doors_move or bool(moving)
        if is_unpredictable:
            self._free_ticks.clear()
        self._active = []
        for robot in self._robots:
            if robot.is_fallen:
                continue
            ticks = self._free_ticks.get(robot, 0)
            if ticks == 0:
                ticks = self._update_active(robot, is_unpredictable=is_unpredictable)
            if ticks > 0:
                robot.move_freely()
                self._free_ticks[robot] = ticks - 1
            else:
                robot.begin_tick()
                self._active.append(robot)
                self._free_ticks[robot] = ticks + 1

    def push(self) -> None:
        """Before a sub-step: apply the wheels of all active robots."""
        for robot in self._active:
            robot.push()

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, which follows `earlier` ones of this tick."""
        for robot in self._active:
            robot.finish_sub_step(earlier)

    def end_tick(self) -> None:
        """Update poses."""
        for robot in self._active:
            robot.end_tick()
        for movable in self._movables.values():
            movable.end_tick()

    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, by robot and in the order in which they began."""
        return tuple(contact for robot in self._active for contact in robot.touching.values())

    def _update_active(self, robot: RobotBody, *, is_unpredictable: bool) -> int:
        """Activate or deactivate a robot; returns its number for `_free_ticks`."""
        # An active robot must be free for longer than one that is not active (hysteresis), so that a robot that drives
        # along a wall does not enter and leave the space all the time.
        if not (robot.touching or is_unpredictable):
            is_alone = len(self._robots) == 1 and not self._is_anything_moving
            at_least = _CHECK_INTERVAL_TICKS if robot.is_active else 1
            ticks = ticks_to_contact(robot, self._broadphase, at_least=at_least, is_alone=is_alone)
            if ticks > 0:
                robot.deactivate(self._space)
                return ticks
        robot.activate(self._space)
        return -_CHECK_INTERVAL_TICKS
