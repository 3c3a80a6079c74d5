"""All robots of a world as one: sensors that can measure all of them in one go do so.

Readings are those of robot by robot (counts may differ where rounding is a matter of the last bit): every sensor has
its own generator on every robot, and draws from it in the same order.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import chain

import numpy as np

from thymio_sim_ros.sim.columns import Columns
from thymio_sim_ros.sim.noise import Noise
from thymio_sim_ros.sim.raycaster import Fan, Indices, Raycaster, Values
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.robot import Robot, Shared

__all__ = ["CROWD", "Crowd"]

CROWD = 6
"""From so many robots on, measuring all at once is quicker (benchmarks/simulator.py)."""

_NOWHERE_M = -1e6


class _Group:
    """The robots as one sensor sees them; satisfies `GroupView`."""

    __slots__ = ("_crowd", "noises")

    def __init__(self, crowd: Crowd, noises: Sequence[Noise]) -> None:
        self._crowd, self.noises = crowd, noises

    def __len__(self) -> int:
        return len(self.noises)

    @property
    def now_ns(self) -> int:
        return self._crowd.shared.clock.now_ns

    @property
    def proximity_model(self) -> str:
        return self._crowd.shared.proximity_model

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        return self._crowd.cast(fan)

    def ground_at(self, places: Values) -> tuple[Values, Values]:
        x, y, yaw = self._crowd.poses().T[:, :, None]
        cos, sin = np.cos(yaw), np.sin(yaw)
        xs = x + cos * places[:, 0] - sin * places[:, 1]
        ys = y + sin * places[:, 0] + cos * places[:, 1]
        reflectances, floors = self._crowd.shared.ground.sample_all(xs.ravel(), ys.ravel())
        return reflectances.reshape(xs.shape), floors.reshape(xs.shape)


class Crowd:
    """The robots of a world, which stay the same. Invariant: nothing here moves them."""

    def __init__(self, robots: Iterable[Robot], shared: Shared) -> None:
        self.shared = shared
        self._caster = Raycaster(shared.physics.fixed, shared.physics.loose())
        self._robots = tuple(robots)
        self._names = tuple(robot.name for robot in self._robots)
        self._groups = [
            _Group(self, [view.noise for _, view in column])
            for column in zip(*(robot.sensors for robot in self._robots), strict=True)
        ]
        self._poses = (-1, np.zeros((0, 3)))

    def poses(self) -> Values:
        """Where they really are now: rows x, y, yaw; who has fallen is far from any floor."""
        if self._poses[0] != self.shared.clock.now_ns:
            found = [
                (body.pose.x_m, body.pose.y_m, body.pose.yaw_rad) if not body.is_fallen else (_NOWHERE_M, row, 0.0)
                for row, body in enumerate(robot.body for robot in self._robots)
            ]
            self._poses = (self.shared.clock.now_ns, np.array(found))
        return self._poses[1]

    def cast(self, fan: Fan) -> tuple[Indices, Values]:
        """What the rays of all robots meet now (`Raycaster.cast`)."""
        fallen = {index for index, robot in enumerate(self._robots) if robot.body.is_fallen}
        self._caster.move(self.shared.physics.loose(), fallen)
        return self._caster.cast(self.poses(), fan)

    def measure(self, due: Sequence[int]) -> Columns:
        """The readings of the sensors with these numbers, and of those woken."""
        woken = {index: found for index, robot in enumerate(self._robots) if (found := robot.take_woken())}
        awake: Sequence[int] = sorted({*due, *chain.from_iterable(woken.values())}) if woken else due
        columns: list[tuple[str, Sequence[Reading | None]]] = []
        for number in awake:
            sensor = self._robots[0].sensors[number][0]
            if number not in due:
                column: Sequence[Reading | None] = [
                    robot.sense(number) if number in woken.get(index, ()) else None
                    for index, robot in enumerate(self._robots)
                ]
            elif sensor.measure_all is not None:
                column = sensor.measure_all(self._groups[number])
            else:
                column = [robot.sense(number) for robot in self._robots]
            columns.append((sensor.name, column))
        return Columns(self._names, columns)
