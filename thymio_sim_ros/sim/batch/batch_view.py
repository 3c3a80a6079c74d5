"""The robots of a crowd as one of their sensors sees them at once."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Protocol, TypeVar

from thymio_sim_ros.sim.audio.propagation import Sound
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays
from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.model.noise import NormalBank, UniformBank
from thymio_sim_ros.sim.physics import Contact, Fleet
from thymio_sim_ros.sim.plugin_api.column_state import Notes
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.raycast.batch import Fan, Indices, Values
from thymio_sim_ros.sim.robot.robot import Robot, Shared

__all__ = ["Group"]

S = TypeVar("S")


class Together(Protocol):
    """The robots as they move and see together."""

    @property
    def shared(self) -> Shared:
        """What all robots of the world share."""
        ...

    @property
    def fleet(self) -> Fleet:
        """Their bodies."""
        ...

    @property
    def wheels(self) -> WheelArrays:
        """Their wheels."""
        ...

    @property
    def poses(self) -> Values:
        """Where they are to be seen: rows x, y, yaw; who has fallen is far from any floor."""
        ...

    def states(self, kind: type[S]) -> list[S]:
        """The state of one actuator of every robot."""
        ...

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """What the rays of all robots meet now."""
        ...


class Group:
    """Satisfies `GroupView`."""

    __slots__ = ("_crowd", "_evens", "_noise", "_robots", "_views", "memory", "notes")

    def __init__(self, crowd: Together, robots: Sequence[Robot], views: Sequence[SensorView]) -> None:
        self._crowd, self._robots, self._views = crowd, robots, views
        self._noise: NormalBank | None = None
        self._evens: UniformBank | None = None
        self.memory: dict[str, Any] = {}
        self.notes = Notes([view.memory for view in views])

    def __len__(self) -> int:
        return len(self._robots)

    def give_back(self) -> None:
        """Let every robot's sensor draw and remember for itself again."""
        for bank in (self._noise, self._evens):
            if bank is not None:
                bank.give_back()
        self.notes.give_back()

    @property
    def noise(self) -> NormalBank:
        assert self._evens is None
        if self._noise is None:
            self._noise = NormalBank([view.noise for view in self._views])
        return self._noise

    @property
    def evens(self) -> UniformBank:
        assert self._noise is None
        if self._evens is None:
            self._evens = UniformBank([view.noise for view in self._views])
        return self._evens

    @property
    def now_ns(self) -> int:
        return self._crowd.shared.clock.now_ns

    @property
    def proximity_model(self) -> str:
        return self._crowd.shared.proximity_model

    @property
    def poses(self) -> Values:
        return self._crowd.fleet.poses

    @property
    def motion(self) -> tuple[Values, Values]:
        return self._crowd.fleet.motion

    @property
    def wheels(self) -> WheelArrays:
        return self._crowd.wheels

    @property
    def fallen(self) -> Sequence[int]:
        found: list[int] = self._crowd.fleet.fallen.tolist()
        return found

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
        return self._crowd.shared.sounds()

    def states(self, kind: type[S]) -> list[S]:
        return self._crowd.states(kind)

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        return self._crowd.cast(fan)

    def ground_at(self, places: Values) -> tuple[Values, Values]:
        return self._crowd.shared.ground.sample_under(self._crowd.poses, places)
