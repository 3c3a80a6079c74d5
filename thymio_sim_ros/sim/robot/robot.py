"""One robot: a body, two wheels, the states of its actuators and stimuli, and a view for each plug-in."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeVar

from thymio_sim_ros.sim.audio.propagation import Sound, SoundSource
from thymio_sim_ros.sim.ground.sampling import NO_FLOOR, Ground, GroundSample
from thymio_sim_ros.sim.mechanics.edge_fall import EdgeFall
from thymio_sim_ros.sim.mechanics.wheels import Wheels
from thymio_sim_ros.sim.model.clock import SimClock
from thymio_sim_ros.sim.model.geometry import LEVEL, Point, Pose, Tilt, Twist
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.noise import Noise
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.model.readings import Reading
from thymio_sim_ros.sim.physics import Contact, Physics, RobotBody
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.playground.scene import RobotSnapshot
from thymio_sim_ros.sim.plugin_api.command_plugin import CommandPlugin, Tilting
from thymio_sim_ros.sim.raycast.scalar import Surroundings
from thymio_sim_ros.sim.robot.plugin_instance import PluginInstance
from thymio_sim_ros.sim.sensors import Sensor

__all__ = ["Robot", "SharedState"]

S = TypeVar("S")

_LIFT_M = 0.06
"""Height at which an operator holds a robot. Assumption."""


class SharedState:
    """State that all robots of a world share."""

    __slots__ = (
        "_audible", "_sounds", "_sounds_ns", "busy", "clock", "ground", "is_noisy", "lidar", "physics",
        "proximity_model", "robots", "seed", "woken",
    )  # fmt: skip

    def __init__(
        self,
        clock: SimClock,
        ground: Ground,
        physics: Physics,
        robots: Mapping[str, Robot],
        *,
        proximity_model: str,
        seed: int,
        is_noisy: bool,
        lidar: Lidar | None,
    ) -> None:
        self.clock, self.ground, self.physics, self.proximity_model = clock, ground, physics, proximity_model
        self.seed, self.is_noisy, self.lidar = seed, is_noisy, lidar
        self.robots = robots
        self.busy: dict[Robot, None] = {}
        """Robots with plug-ins to update in the next tick."""
        self.woken: dict[Robot, None] = {}
        """Robots with a sensor that was woken."""
        self._audible: dict[Robot, None] = {}
        """Robots that may make a sound."""
        self._sounds: list[Sound] = []
        self._sounds_ns = -1

    def forget(self, robot: Robot) -> None:
        """Forget a robot that has left the world."""
        for robots in (self.busy, self.woken, self._audible):
            robots.pop(robot, None)

    def add_audible(self, robot: Robot) -> None:
        """Note that a robot may make a sound from now on."""
        self._audible[robot] = None

    def sounds(self) -> list[Sound]:
        """All sounds now; they are computed once per tick."""
        now_ns = self.clock.now_ns
        if self._sounds_ns != now_ns:
            self._sounds_ns, self._sounds = now_ns, []
            if self._audible:
                for robot in [robot for robot in self.robots.values() if robot in self._audible]:
                    levels = robot.sound_levels(now_ns)
                    self._sounds += [Sound(robot.pose.x_m, robot.pose.y_m, level) for level in levels]
                    if not levels and not robot.may_sound:
                        del self._audible[robot]
        return self._sounds


class _PluginView:
    """A robot as one plug-in sees it; satisfies `SensorView` and `ActuatorView`."""

    __slots__ = ("_clock", "_robot", "_states", "_world", "memory", "noise", "proximity_model")

    def __init__(self, robot: Robot, world: SharedState, user: str) -> None:
        self._robot, self._world, self._states, self._clock = robot, world, robot.states, world.clock
        self.noise = Noise(world.seed, robot.name, user, enabled=world.is_noisy, clock=world.clock)
        self.memory: dict[str, Any] = {}
        self.proximity_model = world.proximity_model

    @property
    def now_ns(self) -> int:
        return self._clock.now_ns

    @property
    def wheels(self) -> Wheels:
        return self._robot.wheels

    @property
    def pose(self) -> Pose:
        return self._robot.body.pose

    @property
    def twist(self) -> Twist:
        return self._robot.twist

    @property
    def tilt(self) -> Tilt:
        return self._robot.tilt

    @property
    def is_falling(self) -> bool:
        return self._robot.is_falling

    @property
    def is_standing(self) -> bool:
        return self._robot.is_standing

    @property
    def contacts(self) -> tuple[Contact, ...]:
        return tuple(self._robot.body.touching.values())

    @property
    def sounds(self) -> list[Sound]:
        return self._world.sounds()

    @property
    def others(self) -> list[Robot]:
        return [robot for robot in self._world.robots.values() if robot is not self._robot]

    def surroundings(self, reach_m: float, height_m: float) -> Surroundings:
        return self._world.physics.surroundings(self._robot.body, reach_m, height_m)

    def ground_at(self, x_m: float, y_m: float) -> GroundSample:
        if not self._robot.is_standing:
            return NO_FLOOR
        return self._world.ground.sample(*self._robot.body.pose.place((x_m, y_m)))

    def state(self, kind: type[S]) -> S:
        state: S = self._states[kind]
        return state

    def draw(self, start: Point, end: Point, width_m: float, color: Color | None) -> Color | None:
        self._world.ground.draw_segment(*start, *end, width_m, color)
        return self._world.ground.color_at(*end)

    def wake(self, kind: type[Any]) -> None:
        self._robot.wake(kind)

    def lift(self, *, is_lifted: bool) -> None:
        self._robot.lift(is_lifted=is_lifted)

    def place(self, pose: Pose) -> None:
        self._robot.place(pose)


class Robot:
    """One robot. Invariant: `World.step` alone makes it act, move and measure, in that order."""

    def __init__(
        self,
        start: RobotStart,
        shared: SharedState,
        plugins: Iterable[CommandPlugin],
        sensors: Iterable[Sensor],
    ) -> None:
        self.name = start.name
        self.body: RobotBody = shared.physics.add_robot(start.name, start.pose)
        self.wheels = Wheels(self.body)
        self._clock, self._physics = shared.clock, shared.physics
        self.edge_fall = EdgeFall(shared.clock, shared.physics, self.body)
        """Detects when it falls off an edge."""
        self.is_lifted = False
        """Whether an operator holds it over the floor: its wheels turn in the air, and it meets and sees nothing."""
        self.states: dict[type[Any], Any] = {}
        """The states of actuators and stimuli, by type."""
        self._accepting: dict[type[Any], tuple[CommandPlugin, Any]] = {}
        self._shown: list[tuple[Callable[[Any], Mapping[str, Any]], Any]] = []
        self._shared = shared
        self.instances: list[PluginInstance] = []
        """The actuators and stimuli with `update`, in name order."""
        for plugin in plugins:
            state = plugin.begin()
            self.states[type(state)] = state
            for kind in plugin.accepts:
                self._accepting[kind] = (plugin, state)
            if plugin.shows is not None:
                self._shown.append((plugin.shows, state))
            if plugin.update is not None:
                view = _PluginView(self, shared, plugin.name)
                self.instances.append(PluginInstance(plugin, state, view))
        self._instance_of = {
            kind: instance
            for instance in self.instances
            for kind, (_, state) in self._accepting.items()
            if instance.state is state
        }
        """The plug-in that acts on a command, by type of the command."""
        self._list_busy()
        self._tilting = [state for state in self.states.values() if isinstance(state, Tilting)]
        self._sound_sources = [state for state in self.states.values() if isinstance(state, SoundSource)]
        self._sounding = [instance for instance in self.instances if isinstance(instance.state, SoundSource)]
        self._sound_commands = {kind for kind, (_, state) in self._accepting.items() if isinstance(state, SoundSource)}
        shared.add_audible(self)
        self.sensors = [(sensor, _PluginView(self, shared, sensor.name)) for sensor in sensors]
        self._wakes: dict[type[Any], list[int]] = {}
        for number, (sensor, _) in enumerate(self.sensors):
            for kind in sensor.wakes_on:
                self._wakes.setdefault(kind, []).append(number)
        self._woken: set[int] = set()

    @property
    def pose(self) -> Pose:
        """True pose."""
        return self.body.pose

    @property
    def twist(self) -> Twist:
        """The true motion of its body, in its own frame."""
        return Twist(self.body.speed_m_s, self.body.turn_rate_rad_s)

    @property
    def tilt(self) -> Tilt:
        """Tilt: held by an operator, or falling off an edge and lying there."""
        return self.edge_fall.tilt or self.held_tilt

    @property
    def held_tilt(self) -> Tilt:
        """The angle at which a plug-in holds the robot; level if none does."""
        for state in self._tilting:
            if state.tilt != LEVEL:
                return state.tilt
        return LEVEL

    @property
    def is_falling(self) -> bool:
        """Whether it is in the air, on its way down from an edge."""
        return self.edge_fall.is_falling

    @property
    def is_fallen(self) -> bool:
        """Whether it has fallen off an edge, falling still or not."""
        return self.edge_fall.tilt is not None

    @property
    def is_standing(self) -> bool:
        """Whether it stands on the floor: it has neither fallen nor been lifted."""
        return self.body.is_standing

    @property
    def height_m(self) -> float:
        """Height over the floor at which an operator holds it; 0 if it is not lifted."""
        return _LIFT_M if self.is_lifted else 0.0

    def sound_levels(self, now_ns: int) -> list[float]:
        """The levels of the sounds that it makes now."""
        levels = (source.sound_level(now_ns) for source in self._sound_sources)
        return [level for level in levels if level]

    @property
    def may_sound(self) -> bool:
        """Whether it may make a sound later without a command."""
        return any(instance.is_busy for instance in self._sounding)

    def accepts(self, command: object) -> bool:
        """Whether an actuator or stimulus accepts this type of command."""
        return type(command) in self._accepting

    def apply(self, command: object) -> None:
        """Pass a command to its actuator or stimulus."""
        kind = type(command)
        plugin, state = self._accepting[kind]
        plugin.apply(state, command, self._clock.now_ns)
        self.wake(kind)
        if kind in self._sound_commands:
            self._shared.add_audible(self)
        instance = self._instance_of.get(kind)
        if instance is not None and not instance.is_busy and not instance.rests:
            instance.is_busy = True
            self._list_busy()

    def wake(self, kind: type[Any]) -> None:
        """Wake the sensors that have this type in `wakes_on`."""
        numbers = self._wakes.get(kind)
        if numbers:
            self._woken.update(numbers)
            self._shared.woken[self] = None

    def act(self, dt_s: float) -> None:
        """Update the busy actuators and stimuli for one tick."""
        has_rested = False
        for instance in self._busy:
            instance.update(instance.state, instance.view, dt_s)
            if instance.rests:
                instance.is_busy, has_rested = False, True
        if has_rested:
            self._list_busy()

    def _list_busy(self) -> None:
        """Collect what has to be updated, in name order, and register the robot as busy."""
        self._busy = tuple(instance for instance in self.instances if instance.is_busy)
        if self._busy:
            self._shared.busy[self] = None
        else:
            self._shared.busy.pop(self, None)

    def pop_woken(self) -> list[int]:
        """Remove and return the numbers of the woken sensors, in order; those with `on_wake` are called instead."""
        if not self._woken:
            return []
        woken, self._woken = sorted(self._woken), set()
        self._shared.woken.pop(self, None)
        for number in woken:
            sensor, view = self.sensors[number]
            if sensor.on_wake is not None:
                sensor.on_wake(view)
        return [number for number in woken if self.sensors[number][0].on_wake is None]

    def measure_one(self, number: int) -> Reading | None:
        """The reading of the sensor with this number, which measures each robot by itself, now."""
        sensor, view = self.sensors[number]
        assert sensor.measure is not None
        return sensor.measure(view)

    def place(self, pose: Pose) -> None:
        """Place it at a pose, at rest, also after a fall; if it is lifted, over that pose."""
        self._physics.place(self.body, pose)
        self.edge_fall.clear()
        if self.is_lifted:
            self._physics.take_off_floor(self.body)

    def lift(self, *, is_lifted: bool) -> None:
        """Lift it off the floor, also after a fall, or put it down where it is."""
        if is_lifted != self.is_lifted:
            self.is_lifted = is_lifted
            self.place(self.pose)

    def state(self, kind: type[S]) -> S:
        """The state of type `kind` of an actuator or stimulus. Raises KeyError if there is none."""
        state: S = self.states[kind]
        return state

    def snapshot(self) -> RobotSnapshot:
        """The visible state now."""
        return RobotSnapshot(
            name=self.name,
            pose=self.body.pose,
            tilt=self.tilt,
            height_m=self.height_m,
            wheel_angles_rad=self.wheels.angles_rad,
            shown={name: value for shows, state in self._shown for name, value in shows(state).items()},
        )
