"""Ray casts of all robots of a world."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.robot_state import RobotState
from thymio_sim_ros.sim.raycast import rays
from thymio_sim_ros.sim.raycast.obstacle_table import FAR_M, ObstacleTable
from thymio_sim_ros.sim.raycast.rays import Candidates, Limits, Mounts, Near, Rays
from thymio_sim_ros.sim.raycast.scalar import Obstacle

__all__ = ["Fan", "Raycaster"]

Values = npt.NDArray[np.float64]


class Fan:
    """The rays of sensors of a robot: origins and unit directions in its frame, range, height above the floor."""

    def __init__(
        self,
        places: Sequence[tuple[float, float]],
        directions: Sequence[Sequence[tuple[float, float]]],
        range_m: float,
        height_m: float,
    ) -> None:
        """`directions` has the rays of each sensor, equally many; the middle one is its axis."""
        self.places = np.array(places).T
        """Origins, shape (2, sensors)."""
        self.directions = np.array(directions).transpose(2, 0, 1)
        """Unit directions, shape (2, sensors, rays)."""
        self.range_m, self.height_m = range_m, height_m
        self.reach_m = range_m + max(math.hypot(x, y) for x, y in places)
        """Distance of the farthest end of a ray from the robot's origin, at most."""


class Raycaster:
    """Casts the rays of the robots of a batch. Objects and doors are updated by `move`."""

    def __init__(
        self,
        memory: KernelMemory,
        robots: RobotState,
        count: int,
        fixed: Sequence[Obstacle],
        loose: Sequence[Obstacle | None] = (),
    ) -> None:
        """Write the obstacles.

        Args:
            memory: that of `robots`; further arrays are allocated in it.
            robots: the robots, of which there are `count`.
            count: number of robots.
            fixed: obstacles that never move.
            loose: obstacles that can move, by number; None for a missing one.
        """
        self._memory, self._robots, self._count = memory, robots, count
        self._table = ObstacleTable(memory, fixed, loose, count)

    def move(self, moved: Mapping[int, Obstacle | None]) -> None:
        """Update movable obstacles, by their numbers; None removes one."""
        for number, obstacle in moved.items():
            self._table.put(self._table.first_loose + number, obstacle)

    def bind(self, fan: Fan) -> tuple[Callable[[], None], Values]:
        """A function that casts the rays of a fan, and the array to which it writes their lengths.

        The array has the shape (robots, sensors, rays); its values are in m, inf for a ray that meets nothing. Fallen
        robots neither detect anything nor are detected.
        """
        memory, table = self._memory, self._table
        _, sensors, rays_per_sensor = fan.directions.shape
        mounts, directions = Mounts(memory, sensors), Rays(memory, sensors * rays_per_sensor)
        axes = fan.directions[:, :, rays_per_sensor // 2]
        mounts.x[:], mounts.y[:] = fan.places
        mounts.axis_x[:], mounts.axis_y[:] = axes
        mounts.cosine[:] = (axes[:, :, None] * fan.directions).sum(axis=0).min(axis=1)
        mounts.sine[:] = np.sqrt(np.maximum(0.0, 1.0 - mounts.cosine**2))
        mounts.first_ray[:] = np.arange(sensors) * rays_per_sensor
        mounts.last_ray[:] = mounts.first_ray + rays_per_sensor
        directions.x[:], directions.y[:] = fan.directions.reshape(2, -1)
        distances = memory.array((self._count, sensors, rays_per_sensor), "float64")
        limits = Limits(memory, 1)
        limits.range[0], limits.reach[0], limits.height[0] = fan.range_m, fan.reach_m, fan.height_m
        candidates, known = Candidates(memory, self._count), Near(memory, table.obstacles.count)
        known.x[:] = FAR_M
        near = memory.array(self._count * table.obstacles.count, "int32")
        call = memory.bind(
            rays.cast, self._robots, table.obstacles, table.planes, mounts, directions, limits, known, candidates,
            near, distances,
        )  # fmt: skip
        return call, distances
