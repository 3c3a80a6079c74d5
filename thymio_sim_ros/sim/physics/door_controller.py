"""The doors of a world, opened while a robot is on a pressure plate of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

import pymunk

from thymio_sim_ros.sim.model.primitives import Solid, Trigger
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.raycast.broadphase import Broadphase

__all__ = ["DoorController"]


class DoorController:
    """Doors by name, in the order of the playground, and the areas that open them."""

    def __init__(self, solids: Iterable[Solid], triggers: Iterable[Trigger], moved: set[Any]) -> None:
        """`moved`: as `DoorBody` has it."""
        self._doors = {solid.name: DoorBody(solid, moved) for solid in solids if solid.slide is not None}
        self._areas = tuple((trigger, *trigger.middle, trigger.reach_m) for trigger in triggers)

    @property
    def doors(self) -> Mapping[str, DoorBody]:
        """All doors."""
        return MappingProxyType(self._doors)

    @property
    def are_still(self) -> bool:
        """Whether no door moves."""
        return not any(door.is_moving for door in self._doors.values())

    def begin_tick(self, broadphase: Broadphase) -> None:
        """Doors set out: they open while a robot is in an area of theirs, and close again."""
        if not self._doors:
            return
        wanted_open = {
            area.door
            for area, x, y, reach_m in self._areas
            for robot in broadphase.movers(x, y, reach_m)
            if isinstance(robot, RobotBody) and area.holds(robot.pose.x_m, robot.pose.y_m)
        }
        for name, door in self._doors.items():
            door.begin_tick(is_wanted_open=name in wanted_open)

    def end_tick(self, space: pymunk.Space) -> None:
        """Doors are where they are to be."""
        for door in self._doors.values():
            door.end_tick(space)
