"""The robots of a batch as one sensor sees them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np

from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays
from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.model.noise import NormalBank, UniformBank
from thymio_sim_ros.sim.physics import Contact, RobotState
from thymio_sim_ros.sim.plugin_api.column_state import ColumnState
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.raycast.batch import Fan, Indices, Values
from thymio_sim_ros.sim.robot.robot import Robot, SharedState

__all__ = ["BatchView"]

S = TypeVar("S")


class RobotArrays(Protocol):
    """The arrays of a batch."""

    @property
    def shared(self) -> SharedState:
        """What all robots of the world share."""
        ...

    @property
    def state(self) -> RobotState:
        """Their motion."""
        ...

    @property
    def fallen(self) -> list[int]:
        """Numbers of the robots that have fallen."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """Their wheels."""
        ...

    @property
    def poses(self) -> Values:
        """Poses, shape (robots, 3): x, y, yaw; a fallen robot is far from any floor."""
        ...

    def states(self, kind: type[S]) -> list[S]:
        """Return the state of one actuator of every robot, in the order of the world."""
        ...

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """Casts the rays of all robots; see `BatchRaycaster.cast`."""
        ...


class BatchView:
    """Satisfies `BatchSensorView`."""

    __slots__ = ("_batch", "_noise", "_robots", "_uniforms", "_views", "column_state", "memory")

    def __init__(self, batch: RobotArrays, robots: Sequence[Robot], views: Sequence[SensorView]) -> None:
        self._batch, self._robots, self._views = batch, robots, views
        self._noise: NormalBank | None = None
        self._uniforms: UniformBank | None = None
        self.memory: dict[str, Any] = {}
        self.column_state = ColumnState([view.memory for view in views])

    def __len__(self) -> int:
        return len(self._robots)

    def release(self) -> None:
        """Return unused random numbers and stored values to the robots."""
        for bank in (self._noise, self._uniforms):
            if bank is not None:
                bank.release()
        self.column_state.release()

    @property
    def noise(self) -> NormalBank:
        assert self._uniforms is None
        if self._noise is None:
            self._noise = NormalBank([view.noise for view in self._views])
        return self._noise

    @property
    def uniforms(self) -> UniformBank:
        assert self._noise is None
        if self._uniforms is None:
            self._uniforms = UniformBank([view.noise for view in self._views])
        return self._uniforms

    @property
    def now_ns(self) -> int:
        return self._batch.shared.clock.now_ns

    @property
    def proximity_model(self) -> str:
        return self._batch.shared.proximity_model

    @property
    def poses(self) -> Values:
        state, count = self._batch.state, len(self._robots)
        return np.stack((state.x[:count], state.y[:count], state.yaw[:count]), axis=1)

    @property
    def motion(self) -> tuple[Values, Values]:
        state, count = self._batch.state, len(self._robots)
        return state.speed[:count], state.turn_rate[:count]

    @property
    def wheels(self) -> WheelArrays:
        return self._batch.wheels

    @property
    def fallen(self) -> Sequence[int]:
        return self._batch.fallen

    @property
    def falling(self) -> Sequence[int]:
        return [robot for robot in self.fallen if self._robots[robot].is_falling]

    @property
    def tilts(self) -> Sequence[Tilt]:
        tilts = [robot.held_tilt for robot in self._robots]
        for robot in self.fallen:
            tilts[robot] = self._robots[robot].tilt
        return tilts

    @property
    def contacts(self) -> Mapping[int, tuple[Contact, ...]]:
        touched = ((number, robot.body.touching) for number, robot in enumerate(self._robots))
        return {number: tuple(touching.values()) for number, touching in touched if touching}

    @property
    def sounds(self) -> Sequence[Sound]:
        return self._batch.shared.sounds()

    def states(self, kind: type[S]) -> list[S]:
        return self._batch.states(kind)

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        return self._batch.cast(fan)

    def ground_at(self, places: Values) -> tuple[Values, Values]:
        return self._batch.shared.ground.sample_under(self._batch.poses, places)
