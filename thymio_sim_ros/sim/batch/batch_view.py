"""All robots of a world as one sensor sees them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from aseba_vm.kernel.record import Record, fields
from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.kernel.memory import KernelMemory
from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.noise import NoiseKeys, noise_keys
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.raycast.raycaster import Fan, Values
from thymio_sim_ros.sim.robot.robot import Robot, SharedState

__all__ = ["BatchView", "Rows", "keys_of"]

S = TypeVar("S")
R = TypeVar("R", bound=Record)

Rows = dict[str, dict[str, Any]]
"""Elements of a record: values by field, by robot."""


class RobotArrays(Protocol):
    """The arrays of a batch."""

    shared: SharedState
    memory: KernelMemory
    tick: npt.NDArray[np.int32]

    def bind_rays(self, fan: Fan) -> tuple[Callable[[], None], Values]:
        """See `Raycaster.bind`; the function also follows what has moved."""
        ...

    def states(self, kind: type[S]) -> list[S]:
        """The state of one actuator of every robot, in the order of the world."""
        ...


class BatchView:
    """Satisfies `BatchSensorView`."""

    def __init__(self, batch: RobotArrays, robots: Sequence[Robot], number: int, before: Rows) -> None:
        """`number` is that of the sensor, `before` are the `rows` of the last batch."""
        self._batch, self._robots, self._before = batch, robots, before
        self._user = robots[0].sensors[number][0].name
        self.memories = [robot.sensors[number][1].memory for robot in robots]
        self._keys: NoiseKeys | None = None
        self._record: Record | None = None
        bodies = batch.shared.physics.robots
        self.robots: RobotState = bodies.state
        self.wheels: WheelState = bodies.wheels
        self.memory, self.tick = batch.memory, batch.tick
        self.array, self.bind, self.bind_rays, self.states = (
            batch.memory.array,
            batch.memory.bind,
            batch.bind_rays,
            batch.states,
        )

    def __len__(self) -> int:
        return len(self._robots)

    @property
    def rows(self) -> Rows:
        """The values of the record."""
        if self._record is None:
            return self._before
        names = list(fields(type(self._record)))
        columns = [getattr(self._record, name).tolist() for name in names]
        rows = zip(*columns, strict=True)
        return {robot.name: dict(zip(names, row, strict=True)) for robot, row in zip(self._robots, rows, strict=True)}

    @property
    def now_ns(self) -> int:
        return self._batch.shared.clock.now_ns

    @property
    def proximity_model(self) -> str:
        return self._batch.shared.proximity_model

    @property
    def lidar(self) -> Lidar | None:
        return self._batch.shared.lidar

    @property
    def ground(self) -> Ground:
        return self._batch.shared.ground

    @property
    def noise_keys(self) -> NoiseKeys:
        if self._keys is None:
            self._keys = keys_of(self.memory, self._robots, self._user, self._batch.shared, len(self))
        return self._keys

    @property
    def tilts(self) -> Sequence[Tilt]:
        return [robot.tilt for robot in self._robots]

    @property
    def heights_m(self) -> Sequence[float]:
        return [robot.height_m for robot in self._robots]

    @property
    def falling(self) -> Sequence[int]:
        return [index for index, robot in enumerate(self._robots) if robot.is_falling]

    @property
    def sounds(self) -> Sequence[Sound]:
        return self._batch.shared.sounds()

    def record(self, kind: type[R]) -> R:
        record = kind(self.memory, len(self._robots))
        self._record = record
        for index, robot in enumerate(self._robots):
            for name, value in self._before.get(robot.name, {}).items():
                getattr(record, name)[index] = value
        return record


def keys_of(memory: KernelMemory, robots: Sequence[Robot], user: str, shared: SharedState, count: int) -> NoiseKeys:
    """The keys of the random numbers of a sensor or actuator on each robot, a record of `count` elements."""
    keys = NoiseKeys(memory, count)
    for index, robot in enumerate(robots):
        keys.key_1[index], keys.key_2[index] = noise_keys(shared.seed, robot.name, user)
    keys.is_on[:] = shared.is_noisy
    return keys
