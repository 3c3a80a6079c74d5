"""Binding of the driving kernels: `DrivingKernelBinding` owns their arrays.

`CompiledActiveBodies` replaces `ActiveBodies` and gives the same bits (tests/sim/kernel/test_batch_kernels.py).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any

import numpy as np
import numpy.typing as npt

from thymio_sim_ros.sim.kernel.compiler import Kernel, parameters
from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.physics import driving_kernel
from thymio_sim_ros.sim.physics.contact import SUB_STEPS
from thymio_sim_ros.sim.physics.pymunk_batch_io import FORCES, SPEEDS, BodyReader, BodyWriter
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["CompiledActiveBodies", "DrivingKernelBinding"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

_ROBOTS, _ACTIVE, _EARLIER, _TOUCHING, _HELD = range(len(driving_kernel.COUNTS))


class DrivingKernelBinding:
    """The arrays of a batch in the memory of kernels, by the names of the parameters of the kernels."""

    def __init__(self, robots: int, bodies: int) -> None:
        """Allocate the arrays for `robots` robots and at most `bodies` bodies in pymunk's space."""
        floats = {
            "driven": (2, robots), "now": (7, robots), "rolling": (4, robots), "headings": (SUB_STEPS + 1, robots),
            "cosines": (SUB_STEPS, robots), "sines": (SUB_STEPS, robots), "bodies": (bodies, 6), "state": (robots, 6),
            "covered": (robots, 2), "speeds": (robots, 3), "wanted": (robots, 6),
            **dict.fromkeys(("yaws", "aims", "ways_x", "ways_y", "pushes_x", "pushes_y", "forces", "along"), (robots,)),
        }  # fmt: skip
        ints = {
            "counts": (len(driving_kernel.COUNTS),),
            **dict.fromkeys(("stands", "is_touching", "numbers", "touching", "held", "rows"), (robots,)),
        }
        self._memory, *arrays = KernelMemory.holding(tuple(floats.values()), tuple(ints.values()))
        self._arrays: dict[str, npt.NDArray[Any]] = dict(zip((*floats, *ints), chain(*arrays), strict=True))
        self.counts = self._arrays["counts"]
        self.counts[_ROBOTS] = robots
        self.driven, self.now = self._arrays["driven"], self._arrays["now"]
        self.stands, self.is_touching = self._arrays["stands"], self._arrays["is_touching"]
        self._headings = self._arrays["headings"][:SUB_STEPS]
        self._cosines, self._sines = self._arrays["cosines"], self._arrays["sines"]
        self._compute_headings, self._start_tick = (
            self._bound(driving_kernel.compute_headings),
            self._bound(driving_kernel.start_tick),
        )
        self.missing_speeds, self.push, self.finish_sub_step = (
            self._bound(one)
            for one in (driving_kernel.missing_speeds, driving_kernel.push, driving_kernel.finish_sub_step)
        )

    def array(self, name: str) -> npt.NDArray[Any]:
        """Return one of the arrays by name. Raises KeyError for an unknown name."""
        return self._arrays[name]

    def _bound(self, kernel: Kernel) -> Callable[[], object]:
        names = parameters(kernel)[0]
        return self._memory.bind(driving_kernel, kernel, *(self._arrays[name] for name in names))

    def start_tick(self) -> None:
        """Integrate all robots by a tick with `driven` into `now`, and start the tick of the active ones."""
        self._compute_headings()
        # Sines and cosines are numpy's, between two kernels: WebAssembly has none, and the bits must be those of the
        # numpy path.
        np.cos(self._headings, out=self._cosines)
        np.sin(self._headings, out=self._sines)
        self._start_tick()


class CompiledActiveBodies:
    """The same as `ActiveBodies`, by kernels and with the same bits; only one may use a binding at a time."""

    def __init__(
        self, binding: DrivingKernelBinding, bodies: Sequence[RobotBody], numbers: Indices, setter: BodyWriter
    ) -> None:
        self.numbers = numbers
        self._binding, self._counts = binding, binding.counts
        self._bodies = [bodies[number].body for number in numbers.tolist()]
        self._setter = setter
        setter.choose(self._bodies)
        self._order = 0
        self._is_any_touching = False
        count = len(numbers)
        self._counts[_ACTIVE] = count
        self._counts[_TOUCHING] = self._counts[_HELD] = 0
        binding.array("numbers")[:count] = numbers
        state = binding.array("state")
        for row, number in enumerate(numbers.tolist()):
            if bodies[number].touching:
                body = bodies[number].body
                state[row, 3:] = *body.velocity, body.angular_velocity
        self._rows = binding.array("rows")[:count]
        self._held = binding.array("held")[:count]
        self._speeds, self._wanted = binding.array("speeds")[:count], binding.array("wanted")[:count]
        names = ("aims", "ways_x", "ways_y", "pushes_x", "pushes_y", "forces")
        self._aims, self._cos, self._sin, self._push_x, self._push_y, self._forces = (
            binding.array(name)[:count] for name in names
        )
        self._space_bodies = binding.array("bodies")

    def __len__(self) -> int:
        return len(self.numbers)

    @property
    def is_any_held(self) -> bool:
        """Whether any robot touches something or has in this tick."""
        return bool(self._counts[_HELD])

    def begin_tick(self, _driven: Values, _rolling: Values, _yaw: Values, touching: Flags | None) -> None:
        """Start a tick; the arrays of the binding have the state already."""
        self._is_any_touching = touching is not None

    def push(self) -> None:
        """Before a sub-step: write speeds, and in contact forces, to pymunk."""
        binding = self._binding
        np.cos(self._aims, out=self._cos)
        np.sin(self._aims, out=self._sin)
        binding.missing_speeds()
        if not self._counts[_TOUCHING]:
            self._setter.set(SPEEDS, self._speeds)
            return
        np.hypot(self._push_x, self._push_y, out=self._forces)
        binding.push()
        self._setter.set(FORCES, self._wanted)

    def finish_sub_step(self, earlier: int, reader: BodyReader, touching: Flags | None) -> None:
        """After a sub-step, which follows `earlier` ones of this tick: read back the held robots."""
        if touching is not None:
            self._is_any_touching = bool(np.count_nonzero(touching))
        counts = self._counts
        if self._is_any_touching or counts[_HELD]:
            reader.read()
            if reader.order != self._order:
                self._order = reader.order
                self._rows[:] = reader.rows(self._bodies)
            # Kernels see only their own memory, so what pymunk has is copied there.
            self._space_bodies[: len(reader.state)] = reader.state
        counts[_EARLIER] = earlier
        self._binding.finish_sub_step()

    def write_held(self, now: Values) -> Indices:
        """Write the state of the held robots to `now`, shape (7, robots); returns their numbers."""
        now[:] = self._binding.now
        numbers: Indices = self.numbers[self._held.nonzero()[0]]
        return numbers
