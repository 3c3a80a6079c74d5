"""Binding of the kernel of proximity counts for a fixed set of robots."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.sensors import _proximity_kernel

__all__ = ["ProximityCounts"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Counts = npt.NDArray[np.int32]


class ProximityCounts:
    """The arrays of the kernel for a fixed number of sensors of one model.

    `cosines` are of the angles between the rays of a sensor and its axis.
    """

    def __init__(self, sensors: int, model: str, cosines: Sequence[float]) -> None:
        rays = len(cosines)
        memory, floats, ints = KernelMemory.holding(
            [(rays,), (sensors, rays), (sensors,)], [(len(_proximity_kernel.COUNTS),), (sensors,), (sensors,)]
        )
        own_cosines, self._distances, self._noise = floats
        self._counts, self._numbers, self._found = ints
        self._counts[:-1] = sensors, rays, robot_constants.PROXIMITY_MODELS.index(model)
        own_cosines[:] = cosines
        self._memory = memory
        self._call = memory.bind(
            _proximity_kernel.proximity,
            self._counts,
            own_cosines,
            self._numbers,
            self._distances,
            self._noise,
            self._found,
        )

    def count(self, numbers: Indices, distances: Values, noise: Values) -> Counts:
        """Return the counts of all sensors, shape (sensors,).

        Args:
            numbers: numbers of the sensors that detect something, shape (seen,).
            distances: distances of their rays in m, shape (seen, rays).
            noise: noise in counts, shape (seen,).
        """
        seen = len(numbers)
        self._counts[-1] = seen
        self._numbers[:seen], self._distances[:seen], self._noise[:seen] = numbers, distances, noise
        self._call()
        found: Counts = self._found.copy()
        return found
