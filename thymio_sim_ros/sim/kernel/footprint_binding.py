"""Binding of the footprint kernel for one ground."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import footprint_kernel
from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["FootprintBinding"]

Values = npt.NDArray[np.float64]
Pixels = npt.NDArray[np.uint16]
Tiles = npt.NDArray[np.int32]


class FootprintBinding:
    """Points of robots on a ground. Invariant: what is drawn into its `pixels` and noted in its `tiles` is seen."""

    def __init__(
        self,
        robots: int,
        points: Values,
        pixels: Pixels,
        tiles: Tiles,
        grays: Values,
        sizes: Sequence[float],
        counts: Sequence[int],
    ) -> None:
        """Rows of `points` are x, y in a robot's frame.

        `counts` and `sizes` are those of the kernel, but for the number of places and the answers.
        Pixels, tiles and grays are copied; later changes must be made to the copies in this object.
        """
        each = (robots, len(points))
        floats = [(len(sizes),), (robots, 3), (2, robots), points.shape, each, each, grays.shape, each, each]
        ints = [(len(footprint_kernel.COUNTS),), tiles.shape, (2 * footprint_kernel.TAPS,)]
        memory = KernelMemory(
            sum(KernelMemory.room(shape, np.float64) for shape in floats)
            + sum(KernelMemory.room(shape, np.int32) for shape in ints)
            + KernelMemory.room(pixels.shape, np.uint16)
        )
        own_sizes, self._poses, self._turns, self._points, xs, ys, self.grays, self._reflectances, self._floors = (
            memory.array(shape, np.float64) for shape in floats
        )
        self._counts, self.tiles, near = (memory.array(shape, np.int32) for shape in ints)
        self.pixels = memory.array(pixels.shape, np.uint16)
        self._counts[:-1] = xs.size, *counts
        own_sizes[:], self._points[:] = sizes, points
        self.pixels[:], self.tiles[:], self.grays[:] = pixels, tiles, grays
        self._memory = memory
        self._go = memory.bind(
            footprint_kernel.spots,
            robots,
            len(points),
            self._poses,
            self._turns,
            self._points,
            xs,
            ys,
        )
        self._see = memory.bind(footprint_kernel.sample, self._counts, own_sizes, xs, ys, self.tiles, self.pixels,
            self.grays, near, self._reflectances, self._floors,
        )  # fmt: skip

    def is_for(self, robots: int, points: Values) -> bool:
        """Whether it is for these points of so many robots."""
        return len(self._poses) == robots and np.array_equal(self._points, points)

    def sample(self, poses: Values) -> tuple[Values, Values] | None:
        """As `Ground.sample_under`; None when a tile is not known."""
        self._poses[:] = poses
        np.cos(self._poses[:, 2], out=self._turns[0])
        np.sin(self._poses[:, 2], out=self._turns[1])
        self._go()
        self._see()
        return None if self._counts[-1] else (self._reflectances.copy(), self._floors.copy())
