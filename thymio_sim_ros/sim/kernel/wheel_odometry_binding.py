"""Binding of the wheel odometry kernels for a fixed set of robots."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel import wheel_odometry_kernel
from thymio_sim_ros.sim.kernel.memory import KernelMemory

__all__ = ["WheelOdometryBinding"]

Values = npt.NDArray[np.float64]


class WheelOdometryBinding:
    """The state of the wheels: `odometry`, shape (3, robots), and `angles`, shape (2, robots); `roll` changes both."""

    def __init__(self, robots: int, dt_s: float, track_m: float, radius_m: float) -> None:
        pair, lone = (2, robots), (robots,)
        shapes = (pair, pair, pair, pair, (3, robots), pair, lone, lone, lone)
        memory, arrays, _ = KernelMemory.holding(shapes)
        self._covered, self._ground, self._commanded, self._speeds, self.odometry, self.angles, *rest = arrays
        self._headings, self._cosines, self._sines = rest
        self._memory = memory
        self.dt_s = dt_s
        self._turn = memory.bind(
            wheel_odometry_kernel,
            wheel_odometry_kernel.turn,
            robots,
            dt_s,
            track_m,
            self._covered,
            self._ground,
            self._commanded,
            self.odometry,
            self._speeds,
            self._headings,
        )
        self._roll = memory.bind(
            wheel_odometry_kernel,
            wheel_odometry_kernel.roll,
            robots,
            dt_s,
            track_m,
            radius_m,
            self._speeds,
            self._cosines,
            self._sines,
            self.odometry,
            self.angles,
        )

    def roll(self, covered: Values, ground: Values, commanded: Values) -> tuple[Values, Values, Values]:
        """Advance by a tick; returns copies of the speeds at the rim, the odometry and the angles after it.

        All arguments are in m/s, shape (2, robots), as in `Wheels`.
        """
        self._covered[:], self._ground[:], self._commanded[:] = covered, ground, commanded
        self._turn()
        np.cos(self._headings, out=self._cosines)
        np.sin(self._headings, out=self._sines)
        self._roll()
        return self._speeds.copy(), self.odometry.copy(), self.angles.copy()
