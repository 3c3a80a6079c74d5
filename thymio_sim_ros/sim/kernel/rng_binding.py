"""Binding of the random number kernel for one bank."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import rng_kernel
from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["RngBinding"]

Values = npt.NDArray[np.float64]


class RngBinding:
    """Numbers drawn ahead: `numbers` has shape (users, width); the first `used` of each row are used up."""

    def __init__(self, users: int, width: int, most: int) -> None:
        """Allocate the arrays, for calls that draw at most `most` numbers."""
        memory, floats, ints = KernelMemory.holding(
            [(users, width), (most,)], [(len(rng_kernel.COUNTS),), (users,), (most,)]
        )
        self.numbers, self._drawn = floats
        self._counts, self.used, self._users = ints
        self._counts[1] = width
        self._memory = memory
        self.most = most
        self._call = memory.bind(rng_kernel.draw, self._counts, self._users, self.numbers, self.used, self._drawn)

    def draw(self, users: npt.NDArray[np.intp]) -> Values | None:
        """Draw a number for each entry of `users`, shape (entries,); valid until the next call.

        Returns None, and draws nothing, if a user has too few numbers left.
        """
        turns = len(users)
        self._users[:turns] = users
        self._counts[0] = turns
        self._call()
        return None if self._counts[2] else self._drawn[:turns]
