"""One robot: a body, two wheels, the state of its actuators, and a view for each plug-in."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, TypeVar, cast

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.actuators.buttons import ButtonState
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.actuators.pen import PenState
from thymio_sim_ros.sim.clock import SimClock
from thymio_sim_ros.sim.geometry import Point, Pose, Twist
from thymio_sim_ros.sim.ground import Ground, GroundSample
from thymio_sim_ros.sim.noise import Noise
from thymio_sim_ros.sim.physics import Contact, Physics, RobotBody
from thymio_sim_ros.sim.playground import RobotStart
from thymio_sim_ros.sim.primitives import Color
from thymio_sim_ros.sim.rays import Surroundings
from thymio_sim_ros.sim.readings import Reading
from thymio_sim_ros.sim.scene import RobotSnapshot
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.sound import Sounding
from thymio_sim_ros.sim.wheels import Wheels

__all__ = ["Robot", "Shared"]

S = TypeVar("S")


class Shared:
    """What all robots of a world share."""

    __slots__ = ("clock", "ground", "physics", "proximity_model", "robots")

    def __init__(
        self, clock: SimClock, ground: Ground, physics: Physics, proximity_model: str, robots: Mapping[str, Robot]
    ) -> None:
        self.clock, self.ground, self.physics, self.proximity_model = clock, ground, physics, proximity_model
        self.robots = robots


class _View:
    """A robot as one plug-in sees it; satisfies `SensorView` and `ActuatorView`."""

    __slots__ = ("_robot", "_world", "memory", "noise", "proximity_model", "wheels")

    def __init__(self, robot: Robot, world: Shared, noise: Noise) -> None:
        self._robot, self._world = robot, world
        self.noise = noise
        self.wheels = robot.wheels
        self.memory: dict[str, Any] = {}
        self.proximity_model = world.proximity_model

    @property
    def now_ns(self) -> int:
        return self._world.clock.now_ns

    @property
    def pose(self) -> Pose:
        return self._robot.body.pose

    @property
    def twist(self) -> Twist:
        return self._robot.twist

    @property
    def contacts(self) -> tuple[Contact, ...]:
        return tuple(self._robot.body.touching.values())

    @property
    def others(self) -> list[Robot]:
        return [robot for robot in self._world.robots.values() if robot is not self._robot]

    def surroundings(self, reach_m: float, height_m: float) -> Surroundings:
        return self._world.physics.surroundings(self._robot.body, reach_m, height_m)

    def ground_at(self, x_m: float, y_m: float) -> GroundSample:
        return self._world.ground.sample(*self._robot.body.pose.place((x_m, y_m)))

    def state(self, kind: type[S]) -> S:
        return self._robot.state(kind)

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        self._world.ground.draw_segment(*start, *end, width_m, color)
        return self._world.ground.color_at(*end)

    def wake(self, kind: type[Any]) -> None:
        self._robot.wake(kind)

    def place(self, pose: Pose) -> None:
        self._world.physics.place(self._robot.body, pose)


class Robot:
    """One robot. Invariant: `World.step` alone makes it act, move and measure, in that order."""

    def __init__(
        self,
        start: RobotStart,
        shared: Shared,
        actuators: Iterable[Actuator],
        sensors: Iterable[Sensor],
        *,
        seed: int,
        noise: bool,
    ) -> None:
        self.name = start.name
        self.body: RobotBody = shared.physics.add_robot(start.name, start.pose)
        self.wheels = Wheels()
        self._clock = shared.clock
        self._states: dict[type[Any], Any] = {}
        self._accepting: dict[type[Any], tuple[Actuator, Any]] = {}
        self._updates = []
        for actuator in actuators:
            state = actuator.begin()
            self._states[type(state)] = state
            for kind in actuator.accepts:
                self._accepting[kind] = (actuator, state)
            if actuator.update is not None:
                view = _View(self, shared, Noise(seed, self.name, actuator.name, enabled=noise))
                self._updates.append((actuator.update, state, view))
        self._sounding = [state for state in self._states.values() if isinstance(state, Sounding)]
        self.sensors = [
            (sensor, _View(self, shared, Noise(seed, self.name, sensor.name, enabled=noise))) for sensor in sensors
        ]
        self._wakes: dict[type[Any], list[int]] = {}
        for number, (sensor, _) in enumerate(self.sensors):
            for kind in sensor.wakes_on:
                self._wakes.setdefault(kind, []).append(number)
        self._woken: set[int] = set()

    @property
    def pose(self) -> Pose:
        """Where it really is."""
        return self.body.pose

    @property
    def twist(self) -> Twist:
        """How its body really moves, in its own frame."""
        return Twist(self.body.speed_m_s, self.body.spin_rad_s)

    @property
    def sounding_level(self) -> float:
        """How loud it is at `sound.NEAR_M`: the sum of all that sounds on it."""
        return sum(state.sounding_level for state in self._sounding)

    def accepts(self, command: object) -> bool:
        """Whether an actuator takes this type of command."""
        return type(command) in self._accepting

    def apply(self, command: object) -> None:
        """Hand a command to its actuator."""
        actuator, state = self._accepting[type(command)]
        actuator.apply(state, command, self._clock.now_ns)
        self.wake(type(command))

    def wake(self, kind: type[Any]) -> None:
        """Let the sensors that wait for this type of thing measure at the end of the tick."""
        self._woken.update(self._wakes.get(kind, ()))

    def act(self, dt_s: float) -> None:
        """Run the actuators for one tick."""
        for update, state, view in self._updates:
            update(state, view, dt_s)
        self.body.drive(self.wheels.ground)

    def roll(self, dt_s: float) -> None:
        """Count on the wheels what the body has moved."""
        self.wheels.roll(self.body.covered_m_s, dt_s)

    def take_woken(self) -> set[int]:
        """The numbers of the sensors that were woken in this tick; afterwards none is."""
        woken = self._woken
        if woken:
            self._woken = set()
        return woken

    def sense(self, number: int) -> Reading | None:
        """What the sensor with this number reads now."""
        sensor, view = self.sensors[number]
        return sensor.measure(view)

    def measure(self, due: Sequence[int]) -> list[tuple[str, str, Reading]]:
        """The readings of the sensors with these numbers, and of those woken: (robot, sensor, reading)."""
        woken = self.take_woken()
        readings = []
        for number in sorted(woken.union(due)) if woken else due:
            sensor, view = self.sensors[number]
            reading = sensor.measure(view)
            if reading is not None:
                readings.append((self.name, sensor.name, reading))
        return readings

    def state(self, kind: type[S]) -> S:
        """The state of the actuator whose state is a `kind`; KeyError when there is none."""
        return cast("S", self._states[kind])

    def snapshot(self) -> RobotSnapshot:
        """How it looks now."""
        return RobotSnapshot(
            name=self.name,
            pose=self.body.pose,
            wheel_angles_rad=self.wheels.angles_rad,
            leds=tuple(self.state(LedState).levels.items()),
            strokes=self.state(PenState).strokes,
            pressed=tuple(button for button, held in self.state(ButtonState).pressed.items() if held),
        )
