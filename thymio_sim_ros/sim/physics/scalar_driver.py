"""The robots of a space, one by one: those that can reach nothing glide, the others are moved by the engine."""

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
"""How often it is worth while to look whether a robot is in nobody's reach any more, and for how long it must be."""


class ScalarDriver:
    """Robots that move one by one."""

    def __init__(
        self,
        space: pymunk.Space,
        robots: Mapping[RobotBody, None],
        movables: Mapping[str, MovableBody],
        broadphase: Broadphase,
    ) -> None:
        """Of the robots those move that have not fallen, whoever they are in a tick."""
        self._space, self._robots, self._movables, self._broadphase = space, robots, movables, broadphase
        self._active: list[RobotBody] = []
        self._is_anything_moving = False
        self._free_ticks: dict[RobotBody, int] = {}
        """For how many ticks each can reach nothing; below 0 it is engaged and looks round again after so many."""

    @property
    def needs_engine(self) -> bool:
        """Whether there is anything for the engine to do in this tick."""
        return self._is_anything_moving or bool(self._active)

    def interrupt(self) -> None:
        """Somebody may be somewhere else now, or gone."""
        self._free_ticks.clear()

    def begin_tick(self, *, do_doors_move: bool) -> None:
        """Let those glide who can reach nothing."""
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
        """Before a sub-step: let all engaged ones take the speeds of their wheels."""
        for robot in self._active:
            robot.push()

    def finish_sub_step(self, earlier: int) -> None:
        """After a sub-step, `earlier` ones done."""
        for robot in self._active:
            robot.finish_sub_step(earlier)

    def end_tick(self) -> None:
        """Tell new poses."""
        for robot in self._active:
            robot.end_tick()
        for movable in self._movables.values():
            movable.end_tick()

    def contacts(self) -> tuple[Contact, ...]:
        """All contacts, by robot and in the order in which they began."""
        return tuple(contact for robot in self._active for contact in robot.touching.values())

    def _update_active(self, robot: RobotBody, *, is_unpredictable: bool) -> int:
        """A number for `_free_ticks`."""
        if not (robot.touching or is_unpredictable):
            is_alone = len(self._robots) == 1 and not self._is_anything_moving
            at_least = _CHECK_INTERVAL_TICKS if robot.is_active else 1
            ticks = ticks_to_contact(robot, self._broadphase, at_least=at_least, is_alone=is_alone)
            if ticks > 0:
                robot.deactivate(self._space)
                return ticks
        robot.activate(self._space)
        return -_CHECK_INTERVAL_TICKS
