"""The robots of a world as a batch: motion, and plug-ins that support it, are computed for all robots at once.

Readings are those of robots one by one, but for counts that are rounded differently due to the last bit: every sensor
has its own random number generator on every robot, and draws from it in the same order.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import chain
from typing import Any, TypeVar

import numpy as np

from thymio_sim_ros.sim.batch.batch_view import BatchView
from thymio_sim_ros.sim.ground.floor_support import FloorSupport
from thymio_sim_ros.sim.mechanics.wheels import WheelArrays
from thymio_sim_ros.sim.model.noise import UniformBank
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.plugin_api.reading_table import ReadingTable
from thymio_sim_ros.sim.plugin_api.view import BatchActuatorView
from thymio_sim_ros.sim.raycast.batch import BatchRaycaster, Fan, Indices, Values
from thymio_sim_ros.sim.robot.robot import Robot, SharedState

__all__ = ["MIN_BATCH_ROBOTS", "RobotBatch"]

Act = Callable[[Sequence[Any], BatchActuatorView, float], None]

S = TypeVar("S")

MIN_BATCH_ROBOTS = 14
"""Number of robots from which on a batch is faster (measured, docs/performance-method.md)."""

_NOWHERE_M = -1e6


class _ActuatorBatchView:
    """The robots as one actuator sees them; satisfies `BatchActuatorView`."""

    __slots__ = ("_clock", "memory", "noise", "wheels")

    def __init__(self, shared: SharedState, wheels: WheelArrays, noise: UniformBank) -> None:
        self._clock, self.wheels, self.noise = shared.clock, wheels, noise
        self.memory: dict[str, Any] = {}

    @property
    def now_ns(self) -> int:
        return self._clock.now_ns


class RobotBatch:
    """The robots of a world; a batch is dissolved when a robot is added or removed."""

    def __init__(self, robots: Iterable[Robot], shared: SharedState) -> None:
        self.shared = shared
        self._raycaster = BatchRaycaster(shared.physics.fixed, shared.physics.movable_obstacles())
        self._robots = tuple(robots)
        self._names = tuple(robot.name for robot in self._robots)
        self._states: dict[type[Any], list[Any]] = {}
        self._order = {robot: index for index, robot in enumerate(self._robots)}
        self._uniform_banks: list[UniformBank] = []
        self._sensors = [sensor for sensor, _ in self._robots[0].sensors]
        self._views = [
            [view for _, view in column] for column in zip(*(robot.sensors for robot in self._robots), strict=True)
        ]
        self._batch_views = {
            number: BatchView(self, self._robots, self._views[number])
            for number, sensor in enumerate(self._sensors)
            if sensor.measure_all is not None
        }
        self.batch_driver = shared.physics.form_batch()
        self.wheels = WheelArrays([robot.wheels for robot in self._robots])
        for robot in self._robots:
            robot.shared_wheels = self.wheels
        self._clearances = np.zeros((3, len(self._robots)))
        """Position at which the distance to the edge was computed last, and the square of that distance, by robot."""
        self._acts: list[tuple[Act, list[Any], _ActuatorBatchView]] = []
        for instances in zip(*(robot.instances for robot in self._robots), strict=True):
            if (update_all := instances[0].update_all) is not None:
                uniform_bank = UniformBank([instance.view.noise for instance in instances])
                self._uniform_banks.append(uniform_bank)
                self._acts.append(
                    (
                        update_all,
                        [instance.state for instance in instances],
                        _ActuatorBatchView(shared, self.wheels, uniform_bank),
                    )
                )

    def __len__(self) -> int:
        return len(self._robots)

    def dissolve(self) -> None:
        """End the batch: robots are updated one by one again."""
        self.shared.physics.dissolve()
        self.wheels.write_back()
        for robot in self._robots:
            robot.shared_wheels = None
        for bank in self._uniform_banks:
            bank.release()
        for view in self._batch_views.values():
            view.release()

    @property
    def poses(self) -> Values:
        """Poses, shape (robots, 3): x, y, yaw; a fallen robot is far from any floor."""
        poses = self.batch_driver.poses
        fallen = self.batch_driver.fallen
        if len(fallen):
            poses = poses.copy()
            poses[fallen] = [(_NOWHERE_M, index, 0.0) for index in fallen]
        return poses

    def states(self, kind: type[S]) -> list[S]:
        """Return the state of one actuator of every robot, in the order of the world."""
        found = self._states.get(kind)
        if found is None:
            found = self._states[kind] = [robot.state(kind) for robot in self._robots]
        return found

    def act(self, dt_s: float) -> None:
        """Run the actuators for one tick."""
        for robot in self._in_order(self.shared.busy):
            robot.act(dt_s, is_batched=True)
        for update_all, states, view in self._acts:
            update_all(states, view, dt_s)
        self.batch_driver.driven = self.wheels.ground

    def roll(self, dt_s: float) -> None:
        """Advance the wheels by the motion of the bodies."""
        self.wheels.roll(self.batch_driver.covered, dt_s)

    def check_floor(self, floor_support: FloorSupport) -> None:
        """Make robots without floor under their origin fall.

        A robot is checked again only when it has moved by the distance to the edge that was found last.
        """
        places = self.batch_driver.poses.T[:2]
        ways = places - self._clearances[:2]
        ways *= ways
        for index in (ways[0] + ways[1] >= self._clearances[2]).nonzero()[0].tolist():
            x, y = places[:, index].tolist()
            self._clearances[:, index] = x, y, self._robots[index].edge_fall.check_floor_at(floor_support, x, y) ** 2

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """Cast the rays of all robots now; see `BatchRaycaster.cast` for the result."""
        self._raycaster.move(self.shared.physics.moved_obstacles(), self.batch_driver.fallen.tolist())
        return self._raycaster.cast(self.poses, fan)

    def measure(self, due: Sequence[int]) -> ReadingTable:
        """Return the readings of the sensors with these numbers, and of those woken."""
        woken = {self._order[robot]: robot.pop_woken() for robot in self._in_order(self.shared.woken)}
        awake: Sequence[int] = sorted({*due, *chain.from_iterable(woken.values())}) if woken else due
        columns: list[tuple[str, Sequence[Reading | None]]] = []
        for number in awake:
            sensor = self._sensors[number]
            if number not in due:
                some = [index for index, numbers in woken.items() if number in numbers]
                column: Sequence[Reading | None] = self._measure_some(number, some)
            elif sensor.measure_all is not None:
                column = sensor.measure_all(self._batch_views[number])
            else:
                column = [sensor.measure(view) for view in self._views[number]]
            columns.append((sensor.name, column))
        return ReadingTable(self._names, columns)

    def _measure_some(self, number: int, some: Sequence[int]) -> Sequence[Reading | None]:
        """Return the readings of one sensor of some robots."""
        column: list[Reading | None] = [None] * len(self._robots)
        view = self._batch_views.get(number)
        for index in some:
            if view is not None:
                view.column_state.write_row(index)
            column[index] = self._robots[index].measure_one(number)
            if view is not None:
                view.column_state.read_row(index)
        return column

    def _in_order(self, some: Collection[Robot]) -> list[Robot]:
        """Return some robots in the order of the world."""
        return [robot for robot in self._robots if robot in some] if some else []
