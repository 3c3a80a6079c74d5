"""The world: owns clock, bodies, ground and robots, and alone lets time pass.

Commands may be posted at any time and take effect in the next step. The same playground, seed and commands
give the same readings bit for bit. One thread may use a world; nothing here locks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

from thymio_sim_ros.sim.actuators import all_actuators
from thymio_sim_ros.sim.clock import TICK_NS, Schedule, SimClock
from thymio_sim_ros.sim.commands import Command, SetPen
from thymio_sim_ros.sim.crowd import CROWD, Crowd
from thymio_sim_ros.sim.fields import as_color
from thymio_sim_ros.sim.geometry import Pose
from thymio_sim_ros.sim.ground import Ground
from thymio_sim_ros.sim.physics import Contact, DoorBody, MovableBody, Physics
from thymio_sim_ros.sim.playground import Playground
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.robot import Robot, Shared
from thymio_sim_ros.sim.scene import Scene, Snapshot
from thymio_sim_ros.sim.sensors import Sensor, all_sensors

__all__ = ["TICK_NS", "StepResult", "World"]

_TICK_S = TICK_NS * 1e-9
PROXIMITY_MODELS = ("default", "enki", "cone")


@dataclass(frozen=True, slots=True)
class StepResult:
    """What one step gave: readings as (robot, sensor, reading), by robot and then by sensor name; contacts."""

    now_ns: int
    readings: Sequence[tuple[str, str, Reading]]
    contacts: tuple[Contact, ...]


class World:
    """A playground that lives. Invariant: nothing in it changes but by `step` and `reset`."""

    def __init__(
        self,
        playground: Playground,
        *,
        seed: int = 0,
        noise: bool = True,
        proximity_model: str = "default",
        periods_ns: Mapping[str, int] | None = None,
    ) -> None:
        """`periods_ns` names the sensors that measure and how often; None: all of them, as often as the robot does."""
        if proximity_model not in PROXIMITY_MODELS:
            raise ValueError(f"proximity model {proximity_model!r}: expected one of {', '.join(PROXIMITY_MODELS)}")
        self._sensors = _chosen(all_sensors(), periods_ns)
        self.playground = playground
        self.scene = Scene.of(playground)
        self._seed, self._noise, self._proximity_model = seed, noise, proximity_model
        self._ground = Ground(playground.floors, playground.paints)
        self.reset()

    def reset(self) -> None:
        """Everything as at the start: time 0, robots at their places, the same noise again, no command waiting."""
        self._clock = SimClock()
        self._ground.restore()
        self._physics = Physics(self.playground.solids, self.playground.triggers)
        self._robots: dict[str, Robot] = {}
        shared = Shared(self._clock, self._ground, self._physics, self._proximity_model, self._robots)
        actuators, sensors = all_actuators(), self._sensors
        self._schedule = Schedule((sensor.period_ns, sensor.phase_ns) for sensor in sensors)
        for start in self.playground.robots:
            robot = Robot(start, shared, actuators, sensors, seed=self._seed, noise=self._noise)
            self._robots[start.name] = robot
            if start.pen is not None:
                pen = start.pen
                robot.apply(SetPen(pen.down, as_color(pen.color), pen.width_m))
        self._posted: list[tuple[Robot, Command]] = []
        self._crowd = Crowd(self._robots.values(), shared) if len(self._robots) >= CROWD else None

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        return self._clock.now_ns

    @property
    def robots(self) -> Mapping[str, Robot]:
        """The robots by name, in the order of the playground."""
        return MappingProxyType(self._robots)

    @property
    def objects(self) -> Mapping[str, Pose]:
        """Where everything that moves without wheels is: movable things, then doors, by name."""
        moving: dict[str, MovableBody | DoorBody] = {**self._physics.movables, **self._physics.doors}
        return MappingProxyType({name: body.pose for name, body in moving.items()})

    def post(self, robot: str, command: Command) -> None:
        """Let a command take effect in the next step; KeyError for an unknown robot, TypeError for no command."""
        found = self._robots[robot]
        if not found.accepts(command):
            raise TypeError(f"no actuator takes a {type(command).__name__}")
        self._posted.append((found, command))

    def step(self) -> StepResult:
        """Let one tick pass."""
        self._apply_commands()
        self._run_actuators()
        contacts = self._move_bodies()
        now_ns = self._clock.advance()
        return StepResult(now_ns, self._run_sensors(now_ns), contacts)

    def snapshot(self) -> Snapshot:
        """How the world looks now."""
        return Snapshot(self._clock.now_ns, tuple(robot.snapshot() for robot in self._robots.values()))

    def _apply_commands(self) -> None:
        posted, self._posted = self._posted, []
        for robot, command in posted:
            robot.apply(command)

    def _run_actuators(self) -> None:
        for robot in self._robots.values():
            robot.act(_TICK_S)

    def _move_bodies(self) -> tuple[Contact, ...]:
        contacts = self._physics.step()
        for robot in self._robots.values():
            robot.roll(_TICK_S)
        for contact in contacts:
            if contact.is_new:
                self._robots[contact.robot].wake(Contact)
        return contacts

    def _run_sensors(self, now_ns: int) -> Sequence[tuple[str, str, Reading]]:
        due = self._schedule.due(now_ns)
        if self._crowd is not None:
            return self._crowd.measure(due)
        readings: list[tuple[str, str, Reading]] = []
        for robot in self._robots.values():
            readings.extend(robot.measure(due))
        return tuple(readings)


def _chosen(sensors: tuple[Sensor, ...], periods_ns: Mapping[str, int] | None) -> tuple[Sensor, ...]:
    """The sensors that measure; ValueError for a name that is none, or a period that is not above 0."""
    if periods_ns is None:
        return sensors
    names = [sensor.name for sensor in sensors]
    for name, period_ns in periods_ns.items():
        if name not in names:
            raise ValueError(f"sensor {name!r}: expected one of {', '.join(names)}")
        if period_ns <= 0:
            raise ValueError(f"period of {name!r}: found {period_ns} ns, expected a number above 0")
    return tuple(replace(sensor, period_ns=periods_ns[sensor.name]) for sensor in sensors if sensor.name in periods_ns)
