"""Converts a playground to a nav_msgs/OccupancyGrid for Nav2 (REP 2003)."""

from __future__ import annotations

from collections.abc import Sequence

from geometry_msgs.msg import Point
from nav_msgs.msg import OccupancyGrid

from thymio_sim_ros.sim.ground.occupancy import grid
from thymio_sim_ros.sim.model.primitives import Floor, Solid

__all__ = ["occupancy"]

FREE, OCCUPIED = 0, 100


def occupancy(floors: Sequence[Floor], solids: Sequence[Solid], frame: str) -> OccupancyGrid:
    """Return the grid of floors and fixed solids in the given frame."""
    found = grid(floors, solids)
    message = OccupancyGrid()
    message.header.frame_id = frame
    message.info.resolution = found.cell_m
    message.info.width, message.info.height = found.columns, found.rows
    message.info.origin.position = Point(x=found.corner[0], y=found.corner[1])
    message.info.origin.orientation.w = 1.0
    message.data = [OCCUPIED if is_occupied else FREE for is_occupied in found.occupied]
    return message
