"""All robots of a world: motion, floor and sensors are computed for all of them at once."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence
from itertools import chain
from typing import Any, TypeVar

from aseba_vm.kernel.types import Ints, kernel
from thymio_sim_ros.sim.batch.batch_view import BatchView, Rows, keys_of
from thymio_sim_ros.sim.ground.floor_support import FloorSupport
from thymio_sim_ros.sim.mechanics import motor_control
from thymio_sim_ros.sim.mechanics.edge_fall import list_unsafe
from thymio_sim_ros.sim.mechanics.wheels import roll
from thymio_sim_ros.sim.model.noise import tick_number
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.model.robot_state import RobotState, WheelState
from thymio_sim_ros.sim.physics import Contact
from thymio_sim_ros.sim.plugin_api.reading_table import LazyReadings, ReadingTable, Row
from thymio_sim_ros.sim.raycast.raycaster import Fan, Raycaster, Values
from thymio_sim_ros.sim.robot.robot import Robot, SharedState

__all__ = ["RobotBatch"]

S = TypeVar("S")
Measure = Callable[[], Sequence[Reading | None]]

_NOBODY: dict[int, list[int]] = {}
_NEVER: tuple[int, Sequence[Reading | None]] = (-1, ())
_SLIP_USER = "motors"
"""Name under which wheels draw the random numbers of their slip."""


@kernel
def finish_tick(robots: RobotState, wheels: WheelState, unsafe: Ints, count: Ints) -> None:
    """After a tick: roll the wheels, and list the robots that may have left the floor."""
    roll(robots, wheels)
    list_unsafe(robots, unsafe, count)


class RobotBatch:
    """The robots of a world; there is a new one when a robot is added or removed."""

    def __init__(self, robots: Iterable[Robot], shared: SharedState, before: dict[str, Rows] | None = None) -> None:
        """`before`: `rows` of the last batch, which must not be used any more."""
        bodies = shared.physics.robots
        self.shared = shared
        self.memory = memory = bodies.memory
        memory.used = bodies.first_free
        self._robots = tuple(robots)
        self._names = tuple(robot.name for robot in self._robots)
        self._order = {robot: index for index, robot in enumerate(self._robots)}
        self._states: dict[type[Any], list[Any]] = {}
        self.tick = memory.array(1, "int32")
        self._unsafe, self._unsafe_count = memory.array(bodies.state.count, "int32"), memory.array(1, "int32")
        slip = keys_of(memory, self._robots, _SLIP_USER, shared, bodies.state.count)
        self._drive = memory.bind(motor_control.drive, bodies.wheels, slip, self.tick, bodies.moving)
        self._finish_tick = memory.bind(finish_tick, bodies.state, bodies.wheels, self._unsafe, self._unsafe_count)
        self._raycaster: Raycaster | None = None
        self._views: dict[str, BatchView] = {}
        sensors = self._robots[0].sensors if self._robots else ()
        self._sensors = [sensor for sensor, _ in sensors]
        self._sensor_names = [sensor.name for sensor in self._sensors]
        self._numbers = {sensor.name: number for number, sensor in enumerate(self._sensors)}
        self._read: dict[str, tuple[int, Sequence[Reading | None]]] = {}
        """The last readings that were measured on request, with their tick, by sensor."""
        self._measure: list[Measure] = []
        for number, sensor in enumerate(self._sensors):
            if sensor.prepare_all is not None:
                view = BatchView(self, self._robots, number, (before or {}).get(sensor.name, {}))
                self._views[sensor.name] = view
                self._measure.append(sensor.prepare_all(view))
            else:
                self._measure.append(self._one_by_one(number))

    @property
    def rows(self) -> dict[str, Rows]:
        """The elements that sensors have in their records, by sensor, then by robot."""
        return {name: view.rows for name, view in self._views.items()}

    def states(self, kind: type[S]) -> list[S]:
        """The state of one actuator of every robot, in the order of the world."""
        found = self._states.get(kind)
        if found is None:
            found = self._states[kind] = [robot.state(kind) for robot in self._robots]
        return found

    def bind_rays(self, fan: Fan) -> tuple[Callable[[], None], Values]:
        """See `Raycaster.bind`; the function also follows what has moved."""
        physics = self.shared.physics
        if self._raycaster is None:
            movable = physics.movable_obstacles()
            self._raycaster = Raycaster(self.memory, physics.robots.state, len(self._robots), physics.fixed, movable)
        move, moved_obstacles = self._raycaster.move, physics.moved_obstacles
        cast, distances = self._raycaster.bind(fan)

        def move_and_cast() -> None:
            moved = moved_obstacles()
            if moved:
                move(moved)
            cast()

        return move_and_cast, distances

    def act(self, dt_s: float) -> None:
        """Run the actuators for one tick."""
        self.tick[0] = tick_number(self.shared.clock.now_ns)
        if self.shared.busy:
            for robot in self._in_order(self.shared.busy):
                robot.act(dt_s)
        self._drive()

    def move(self, floor_support: FloorSupport) -> tuple[Contact, ...]:
        """Move all bodies by a tick; robots without floor under their origin fall. Returns the contacts."""
        contacts = self.shared.physics.step()
        self._finish_tick()
        # A robot is checked again only when it has moved by the distance to the edge that was found last.
        if self._unsafe_count[0]:
            for index in self._unsafe[: self._unsafe_count[0]].tolist():
                self._robots[index].edge_fall.check_floor(floor_support)
        return contacts

    def measure(self, due: Sequence[int]) -> Sequence[Row]:
        """The readings of the sensors with these numbers, and of those woken."""
        self.tick[0] = tick_number(self.shared.clock.now_ns)
        if not self._robots:
            return ()
        woken, awake = _NOBODY, due
        if self.shared.woken:
            woken = {self._order[robot]: robot.pop_woken() for robot in self._in_order(self.shared.woken)}
            awake = sorted({*due, *chain.from_iterable(woken.values())})
        columns: list[tuple[str, Sequence[Reading | None]]] = []
        for number in awake:
            if awake is due or number in due:
                column = self._measure[number]()
            else:
                some = [index for index, numbers in woken.items() if number in numbers]
                column = [
                    robot.measure_one(number) if index in some else None for index, robot in enumerate(self._robots)
                ]
            if type(column) is LazyReadings or any(column):
                columns.append((self._sensor_names[number], column))
        return ReadingTable(self._names, columns) if columns else ()

    def read(self, robot: Robot, sensor: str) -> Reading | None:
        """The present reading of a stateless sensor of one robot. Raises KeyError for an unknown sensor."""
        now_ns, (read_ns, column) = self.shared.clock.now_ns, self._read.get(sensor, _NEVER)
        if read_ns != now_ns:
            self.tick[0] = tick_number(now_ns)
            column = self._measure[self._numbers[sensor]]()
            self._read[sensor] = (now_ns, column)
        return column[self._order[robot]]

    def _one_by_one(self, number: int) -> Measure:
        """A function that measures a sensor of all robots, one after the other."""
        sensor, views = self._sensors[number], [robot.sensors[number][1] for robot in self._robots]
        measure = sensor.measure
        assert measure is not None
        return lambda: [measure(view) for view in views]

    def _in_order(self, some: Collection[Robot]) -> list[Robot]:
        """Some robots in the order of the world."""
        if len(some) < 2:
            return list(some)
        return sorted(some, key=self._order.__getitem__)
