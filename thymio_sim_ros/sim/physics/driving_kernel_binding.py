"""A fleet and its engaged robots by kernels: `Driving` has their arrays, `CompiledEngaged` does what `Engaged` does.

Both give the same bits (tests/sim/kernel/test_crowds.py).
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
from thymio_sim_ros.sim.physics.pymunk_batch_io import FORCES, SPEEDS, Reader, Setter
from thymio_sim_ros.sim.physics.robot_body import RobotBody

__all__ = ["CompiledEngaged", "Driving"]

Values = npt.NDArray[np.float64]
Indices = npt.NDArray[np.intp]
Flags = npt.NDArray[np.bool_]

_ROBOTS, _ENGAGED, _EARLIER, _TOUCHING, _HELD = range(len(driving_kernel.COUNTS))


class Driving:
    """The arrays of a fleet in the memory of kernels, by the names that the kernels give them."""

    def __init__(self, robots: int, bodies: int) -> None:
        """`bodies`: how many there may be in the engine's space."""
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
        self._head, self._go = self._bound(driving_kernel.head), self._bound(driving_kernel.go)
        self.lack, self.push, self.settle = (
            self._bound(one) for one in (driving_kernel.lack, driving_kernel.push, driving_kernel.settle)
        )

    def array(self, name: str) -> npt.NDArray[Any]:
        """One of the arrays."""
        return self._arrays[name]

    def _bound(self, kernel: Kernel) -> Callable[[], object]:
        names = parameters(kernel)[0]
        return self._memory.bind(driving_kernel, kernel, *(self._arrays[name] for name in names))

    def go(self) -> None:
        """As `Fleet` without kernels: all of `now` after a tick with `driven`; and the engaged begin theirs."""
        self._head()
        np.cos(self._headings, out=self._cosines)
        np.sin(self._headings, out=self._sines)
        self._go()


class CompiledEngaged:
    """As `Engaged`, of a fleet that glides by the same `Driving`; one at a time."""

    def __init__(self, driving_: Driving, bodies: Sequence[RobotBody], numbers: Indices, setter: Setter) -> None:
        self.numbers = numbers
        self._driving, self._counts = driving_, driving_.counts
        self._bodies = [bodies[number].body for number in numbers.tolist()]
        self._setter = setter
        setter.choose(self._bodies)
        self._order = 0
        self._is_anybody_touching = False
        count = len(numbers)
        self._counts[_ENGAGED] = count
        self._counts[_TOUCHING] = self._counts[_HELD] = 0
        driving_.array("numbers")[:count] = numbers
        state = driving_.array("state")
        for row, number in enumerate(numbers.tolist()):
            if bodies[number].touching:
                body = bodies[number].body
                state[row, 3:] = *body.velocity, body.angular_velocity
        self._rows = driving_.array("rows")[:count]
        self._held = driving_.array("held")[:count]
        self._speeds, self._wanted = driving_.array("speeds")[:count], driving_.array("wanted")[:count]
        names = ("aims", "ways_x", "ways_y", "pushes_x", "pushes_y", "forces")
        self._aims, self._cos, self._sin, self._push_x, self._push_y, self._forces = (
            driving_.array(name)[:count] for name in names
        )
        self._space_bodies = driving_.array("bodies")

    def __len__(self) -> int:
        return len(self.numbers)

    @property
    def is_anybody_held(self) -> bool:
        """As `Engaged`."""
        return bool(self._counts[_HELD])

    def begin_tick(self, _driven: Values, _rolling: Values, _yaw: Values, touching: Flags | None) -> None:
        """As `Engaged`; what the fleet knows is in the arrays already, and they have begun."""
        self._is_anybody_touching = touching is not None

    def push(self) -> None:
        """As `Engaged`."""
        driving_ = self._driving
        np.cos(self._aims, out=self._cos)
        np.sin(self._aims, out=self._sin)
        driving_.lack()
        if not self._counts[_TOUCHING]:
            self._setter.set(SPEEDS, self._speeds)
            return
        np.hypot(self._push_x, self._push_y, out=self._forces)
        driving_.push()
        self._setter.set(FORCES, self._wanted)

    def settle(self, earlier: int, reader: Reader, touching: Flags | None) -> None:
        """As `Engaged`."""
        if touching is not None:
            self._is_anybody_touching = bool(np.count_nonzero(touching))
        counts = self._counts
        if self._is_anybody_touching or counts[_HELD]:
            reader.read()
            if reader.order != self._order:
                self._order = reader.order
                self._rows[:] = reader.rows(self._bodies)
            self._space_bodies[: len(reader.state)] = reader.state
        counts[_EARLIER] = earlier
        self._driving.settle()

    def note(self, now: Values) -> Indices:
        """As `Engaged`."""
        now[:] = self._driving.now
        numbers: Indices = self.numbers[self._held.nonzero()[0]]
        return numbers
