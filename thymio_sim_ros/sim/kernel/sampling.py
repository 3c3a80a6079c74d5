"""The kernel of footprints for one ground: its arrays, and how it is called."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import footprints
from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["Sampling"]

Values = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.uint16]
Tiles = npt.NDArray[np.int32]


class Sampling:
    """So many places on a ground. Invariant: what is drawn into its `pixels` and noted in its `tiles` is seen."""

    def __init__(
        self,
        places: int,
        pixels: Pixels,
        tiles: Tiles,
        greys: Values,
        sizes: Sequence[float],
        counts: Sequence[int],
    ) -> None:
        """`counts` and `sizes` as the kernel has them, without the number of places and answers.

        Pixels, tiles and greys are copied; whoever changes them changes those of this object from now on.
        """
        floats = [(len(sizes),), (places,), (places,), greys.shape, (places,), (places,)]
        ints = [(len(footprints.COUNTS),), tiles.shape, (2 * footprints.TAPS,)]
        memory = KernelMemory(
            sum(KernelMemory.room(shape, np.float64) for shape in floats)
            + sum(KernelMemory.room(shape, np.int32) for shape in ints)
            + KernelMemory.room(pixels.shape, np.uint16)
        )
        self.places = places
        own_sizes, self._x, self._y, self.greys, self._reflectances, self._floors = (
            memory.array(shape, np.float64) for shape in floats
        )
        self._counts, self.tiles, near = (memory.array(shape, np.int32) for shape in ints)
        self.pixels = memory.array(pixels.shape, np.uint16)
        self._counts[:-1] = places, *counts
        own_sizes[:] = sizes
        self.pixels[:], self.tiles[:], self.greys[:] = pixels, tiles, greys
        self._memory = memory
        self._call = memory.bind(
            footprints, footprints.sample, self._counts, own_sizes, self._x, self._y, self.tiles, self.pixels,
            self.greys, near, self._reflectances, self._floors,
        )  # fmt: skip

    def sample(self, x_m: Values, y_m: Values) -> tuple[Values, Values] | None:
        """As `Ground.sample_all`, of exactly so many places; None when a tile is not known."""
        self._x[:], self._y[:] = x_m, y_m
        self._call()
        return None if self._counts[-1] else (self._reflectances.copy(), self._floors.copy())
