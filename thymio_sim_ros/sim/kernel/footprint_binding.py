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
    """The arrays of the footprint kernel for one ground and a fixed number of robots.

    `pixels`, `tiles` and `grays` are the memory of the kernel: the ground must draw into them from then on.
    """

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
        """Allocate the arrays and copy the ground into them.

        Args:
            robots: number of robots.
            points: x, y of the footprints in the robot's frame, shape (points, 2).
            pixels: color numbers of the ground, shape (rows, columns).
            tiles: the only color of each tile, shape (tile rows, tile columns).
            grays: gray of each color number.
            sizes: see `footprint_kernel.sample`.
            counts: those of the kernel, without the number of places and the result.
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
        """Return whether it was made for these points of this number of robots."""
        return len(self._poses) == robots and np.array_equal(self._points, points)

    def sample(self, poses: Values) -> tuple[Values, Values] | None:
        """Return reflectances and parts of floor, shape (robots, points) each, or None if a tile is unknown.

        `poses` are x, y, yaw of the robots, shape (robots, 3).
        """
        self._poses[:] = poses
        np.cos(self._poses[:, 2], out=self._turns[0])
        np.sin(self._poses[:, 2], out=self._turns[1])
        self._go()
        self._see()
        return None if self._counts[-1] else (self._reflectances.copy(), self._floors.copy())
