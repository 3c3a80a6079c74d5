"""The doors of a world; a door opens while a robot is on one of its pressure plates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import pymunk

from thymio_sim_ros.sim.model.primitives import Solid, Trigger
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["DoorController"]


class DoorController:
    """Doors by name, in the order of the playground, and the areas that open them."""

    def __init__(self, solids: Iterable[Solid], triggers: Iterable[Trigger], moved: set[Any]) -> None:
        """Create the doors; each adds itself to `moved` whenever its obstacle has changed."""
        self._doors = {solid.name: DoorBody(solid, moved) for solid in solids if solid.slide is not None}
        self._areas = tuple((trigger, *trigger.middle, trigger.reach_m) for trigger in triggers)

    @property
    def doors(self) -> Mapping[str, DoorBody]:
        """All doors by name."""
        return MappingProxyType(self._doors)

    @property
    def are_still(self) -> bool:
        """Whether no door moves."""
        return not any(door.is_moving for door in self._doors.values())

    def begin_tick(self, robots: Iterable[RobotBody]) -> None:
        """Open the doors that have a robot on a pressure plate, close the others."""
        if not self._doors:
            return
        wanted_open = {
            area.door
            for area, x, y, reach_m in self._areas
            for robot in robots
            if math.hypot(robot.pose.x_m - x, robot.pose.y_m - y) <= reach_m
            and robot.is_standing
            and area.holds(robot.pose.x_m, robot.pose.y_m)
        }
        for name, door in self._doors.items():
            door.begin_tick(is_wanted_open=name in wanted_open)

    def end_tick(self, space: pymunk.Space) -> None:
        """Put all doors at their positions after this tick."""
        for door in self._doors.values():
            door.end_tick(space)
