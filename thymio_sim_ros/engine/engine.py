"""World and devices in lock-step: the only owner of simulated time, and of what happens in which order.

One step: (1) the world ticks; (2) each device gets its readings; (3) the devices that are due run in the order of the
playground, and emitted events are forwarded to the other devices until none is pending; (4) the commands are posted to
the world and take effect in the next tick. Between steps, inputs are applied (`inputs.py`). The same start and the same
inputs at the same ticks give the same run bit for bit, whatever is read.

What measures in every tick without noise or memory, such as the speeds of the motors, is measured when a program runs
or its variables are read (`AsebaDevice.measure_on_read`), unless a program handles its event.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence, Set
from dataclasses import replace

from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.network_node import QUESTIONS
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.robot_device import RobotHost, RobotNode
from thymio_sim_ros.engine.devices import Devices, SentMessages
from thymio_sim_ros.engine.inputs import (
    DevicesAdded,
    DeviceStart,
    DrawingsErased,
    EventSent,
    GroundPainted,
    Input,
    Loaded,
    MessagesReceived,
    Posted,
    Recorder,
    Removed,
    Reset,
    RunStart,
    Spawned,
    VariableSet,
)
from thymio_sim_ros.sim.commands import MOTOR_MODELS, Command, PressButton
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground, RobotStart
from thymio_sim_ros.sim.plugin_api.reading_table import ReadingTable
from thymio_sim_ros.sim.sensors import all_sensors
from thymio_sim_ros.sim.world import StepResult, World

__all__ = ["DIGEST_TICKS", "Engine"]

DIGEST_TICKS = 100
"""Ticks between two digests of the state that a recorder gets: one second."""

_SECOND_NS = 1_000_000_000
_DIGEST_BYTES = 8


class Engine:
    """A world, and a device for each robot that has a program or a behaviour."""

    def __init__(
        self,
        playground: Playground,
        programs: Mapping[str, ThymioProgram | DeviceStart] | ThymioProgram | None = None,
        *,
        behaviour: str = "",
        options: DeviceOptions = DEFAULTS,
        motor_model: str = MOTOR_MODELS[0],
        proximity_model: str = PROXIMITY_MODELS[0],
        seed: int = 0,
        noise: bool = True,
        periods_ns: Mapping[str, int] | None = None,
        lidar: Lidar | None = None,
        solid_robots: bool = True,
        shares_numbers: bool = False,
        ground: Ground | None = None,
    ) -> None:
        """Create the world and a device for each robot with a program: one program for all, or one by robot name.

        With a `behaviour`, such as "menu", every robot is switched on with that, and a program waits in its menu. A
        `DeviceStart` in place of a program says all of one robot. `periods_ns`, `lidar`, `solid_robots`: see `World`.
        `shares_numbers`: see `RunStart`. A `ground` of the playground that exists already, from a run that has ended,
        need not be painted again. SdCardError, SettingsError: a folder of the options cannot be used.
        """
        self.world = World(
            playground,
            seed=seed,
            noise=noise,
            motor_model=motor_model,
            proximity_model=proximity_model,
            periods_ns=periods_ns,
            lidar=lidar,
            solid_robots=solid_robots,
            ground=ground,
        )
        starts = _device_starts(list(self.world.robots), programs, behaviour)
        self.start = RunStart(playground, self.world.options, starts, options, shares_numbers)
        """Start of the run, since the last reset."""
        self.recorders: list[Recorder] = []
        """Get the inputs from now on, and digests of the state."""
        self._devices = Devices(self._choose_fed)
        self.devices: dict[str, AsebaDevice] = {}
        """The device of each robot that has one."""
        self._robot_changes = -1
        """`world.robot_changes` when the present devices were updated."""
        self._device_of_robot: list[AsebaDevice | None] = []
        """The device of each robot in the world, in its order."""
        self._bound: frozenset[str] = frozenset()
        """Sensors whose readings are variables of a program."""
        self._on_read: frozenset[str] = frozenset()
        """Sensors that measure when variables are read, unless a program handles their events."""
        self._fed: frozenset[str] = frozenset()
        """Sensors whose readings are fed to the devices."""
        self._wanted_events: list[frozenset[int]] = []
        """The local events that the devices wanted when `_fed` was chosen."""
        self._create_devices(DevicesAdded(starts, options, shares_numbers))
        self._begin()

    @classmethod
    def of(cls, start: RunStart, ground: Ground | None = None) -> Engine:
        """Return an engine that starts so. Raises ValueError for wrong options."""
        world = start.world
        return cls(
            start.playground,
            start.devices,
            options=start.options,
            motor_model=world.motor_model,
            proximity_model=world.proximity_model,
            seed=world.seed,
            noise=world.noise,
            shares_numbers=start.shares_numbers,
            periods_ns=None if world.periods_ns is None else dict(world.periods_ns),
            lidar=world.lidar,
            solid_robots=world.solid_robots,
            ground=ground,
        )

    @property
    def hosts(self) -> Mapping[str, RobotHost]:
        """The selection of the program of each robot that has a device."""
        return self._devices.hosts

    @property
    def nodes(self) -> Mapping[str, RobotNode]:
        """Each robot with a device as a node of an Aseba network."""
        return self._devices.nodes

    @property
    def emitted(self) -> Sequence[tuple[str, EmittedEvent]]:
        """The events of the last step as (robot, event), in order."""
        return self._devices.emitted

    @property
    def ran(self) -> Set[str]:
        """The robots whose devices ran in the last step."""
        return self._devices.ran

    @property
    def runs(self) -> int:
        """Number of times that the devices have run."""
        return self._devices.runs

    @property
    def has_clients(self) -> bool:
        """Whether a robot's network has clients."""
        return self._devices.has_clients

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        return self.world.now_ns

    @property
    def tick(self) -> int:
        """Number of ticks since the start or the last reset."""
        return self.world.now_ns // TICK_NS

    def step(self, sensors: Collection[str] | None = None) -> StepResult:
        """Run one tick of the world and of the programs.

        `sensors`: names of the sensors whose readings the result must have; None: all. See `World.step`.
        """
        if self._devices.is_due(self.world.now_ns):  # as it is after another program was loaded
            self._choose_fed()
        wanted = sensors if sensors is None else self._fed if not sensors else self._fed.union(sensors)
        result = self.world.step(wanted)
        if self.devices:
            self._update_present_devices()
            if isinstance(result.readings, ReadingTable):
                self._feed(result.readings, result.now_ns)
            self._run_devices()
        if self.recorders and self.tick % DIGEST_TICKS == 0:
            self._record_digest()
        return result

    def run(self, seconds: float) -> None:
        """Run for this many simulated seconds."""
        for _ in range(_ticks(seconds)):
            self.step(())

    def steps(self, seconds: float, sensors: Collection[str] | None = None) -> Iterator[StepResult]:
        """Run for this many simulated seconds; yield the result of each tick, see `step`."""
        for _ in range(_ticks(seconds)):
            yield self.step(sensors)

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Run until the condition is true, at most this many simulated seconds; return whether it became true."""
        end_ns = self.now_ns + round(seconds * _SECOND_NS)
        while not condition():
            if self.now_ns >= end_ns:
                return False
            self.step(())
        return True

    def apply(self, happened: Input) -> None:
        """Apply an input now, and give it to the recorder if it is accepted.

        Raises what the world raises for commands and robots (`World.post`, `spawn`, `remove`), KeyError for a robot
        without a device, an unknown variable or event, and ValueError for a wrong number of words or control.
        """
        tick = self.tick
        match happened:
            case Posted(name, command):
                self.world.post(name, command)
            case Spawned(start):
                self.world.spawn(start)
            case Removed(name):
                self.world.remove(name)
            case DrawingsErased():
                self.world.erase_drawings()
            case GroundPainted(color):
                self.world.paint_ground(color)
            case Reset():
                self._reset()
            case DevicesAdded():
                self._add_devices(happened)
            case _:
                self._update_present_devices()
                if isinstance(happened, Loaded):
                    self.devices[happened.robot].end_tick(self.now_ns)
                if self._devices.apply(happened):
                    self._choose_fed()
                    self._run_devices()
        if not _is_question(happened):
            for recorder in self.recorders:
                recorder.record(tick, happened)

    def post(self, robot: str, command: Command) -> None:
        """Post a command for a robot or an object; it takes effect in the next tick. Raises as `World.post` does."""
        self.apply(Posted(robot, command))

    def press(self, robot: str, button: str, *, pressed: bool = True) -> None:
        """Press or release a button."""
        self.post(robot, PressButton(button, pressed))

    def spawn(self, start: RobotStart) -> None:
        """Add a robot at once. Raises as `World.spawn` does."""
        self.apply(Spawned(start))

    def remove(self, robot: str) -> None:
        """Remove a robot at once; raises KeyError for an unknown name."""
        self.apply(Removed(robot))

    def erase_drawings(self) -> None:
        """Erase everything that pens drew."""
        self.apply(DrawingsErased())

    def paint_ground(self, color: tuple[float, float, float]) -> None:
        """Give the first floor another color until the next reset. Raises ValueError as `World.paint_ground` does."""
        self.apply(GroundPainted(color))

    def load(self, robot: str, program: ThymioProgram) -> None:
        """Load another program, which starts now. Raises KeyError for a robot without a device."""
        self.apply(Loaded(robot, program))

    def send_event(self, event: str, args: Sequence[int] = (), robots: Collection[str] | None = None) -> None:
        """Send a global event to the programs that declare it, or to those of these robots.

        They handle it in the next tick. Raises KeyError if one of the given robots, or no robot, declares it.
        """
        if robots is None:
            robots = [name for name, device in self.devices.items() if device.declares(event)]
            if not robots:
                raise KeyError(event)
        self.apply(EventSent(tuple(robots), event, tuple(args)))

    def set_variable(self, robot: str, variable: str, words: Sequence[int]) -> None:
        """Write a whole variable of a program. Raises KeyError for an unknown name, ValueError for wrong words."""
        self.apply(VariableSet(robot, variable, tuple(words)))

    def pop_sent(self) -> list[SentMessages]:
        """Return and clear the messages for clients of the robots' networks, in order."""
        return self._devices.pop_sent()

    def reset(self) -> None:
        """Reset world, noise and programs to the start."""
        self.apply(Reset())

    def release(self, recorder: Recorder) -> None:
        """Give the last state to a recorder, which gets nothing more."""
        self.recorders.remove(recorder)
        recorder.record_digest(self.tick, self.digest())

    def digest(self) -> str:
        """Digest of the visible state, exact to the bit: poses, lights and variables, as 16 hexadecimal digits."""
        shown = self.world.snapshot()
        state = (
            shown.now_ns,
            [(one.name, one.pose, one.tilt, one.height_m, one.wheel_angles_rad, one.leds) for one in shown.robots],
            shown.objects,
            [(name, device.variables.words(), device.status) for name, device in self.devices.items()],
        )
        return hashlib.blake2b(repr(state).encode(), digest_size=_DIGEST_BYTES).hexdigest()

    def _create_devices(self, added: DevicesAdded) -> None:
        if added.devices and not self._bound:
            self._bound = frozenset(bindings.sensor_names())
            self._on_read = self._bound & {
                sensor.name for sensor in all_sensors() if sensor.is_stateless and sensor.period_ns <= TICK_NS
            }
            self._fed = self._bound
        devices = self._devices.create(added, alone=len(self.world.robots) == 1)
        self.devices |= devices
        for name, device in devices.items():
            device.measure_on_read(self._on_read, self._measuring(name))
        self._devices.begin(added.devices)

    def _add_devices(self, added: DevicesAdded) -> None:
        self._create_devices(added)
        self.start = replace(self.start, options=added.options, shares_numbers=added.shares_numbers)
        for name in added.devices:
            self.devices[name].advance(self.now_ns)
        self._robot_changes = -1
        self._update_present_devices(restart=False)
        self._choose_fed()
        self._run_devices()

    def _reset(self) -> None:
        if self.recorders:
            self._record_digest()
        self.world.reset()
        for name in self.devices.keys() - self.world.robots.keys():
            del self.devices[name]
            self._devices.remove(name)
        self.start = replace(self.start, devices=self._devices.starts())
        for host in self.hosts.values():
            host.restart()
        self._begin()

    def _begin(self) -> None:
        self._devices.present = dict(self.devices)
        for device in self.devices.values():
            device.advance(self.now_ns)
        self._run_devices()
        self._choose_fed()

    def _record_digest(self) -> None:
        digest = self.digest()
        for recorder in self.recorders:
            recorder.record_digest(self.tick, digest)

    def _run_devices(self) -> None:
        for name, command in self._devices.run(self.now_ns):
            self.world.post(name, command)

    def _feed(self, table: ReadingTable, now_ns: int) -> None:
        for sensor, readings in table.columns:
            if sensor in self._bound:
                for device, reading in zip(self._device_of_robot, readings, strict=True):
                    if device is not None and reading is not None:
                        device.feed(sensor, reading.words, now_ns)

    def _choose_fed(self) -> None:
        """Choose the sensors whose readings are fed; the others are measured when variables are read."""
        wanted = [device.local_events.wanted for device in self.devices.values()]
        if wanted != self._wanted_events:
            self._wanted_events = wanted
            self._fed = frozenset(
                sensor
                for sensor in self._bound
                if sensor not in self._on_read or any(device.wants_event(sensor) for device in self.devices.values())
            )

    def _measuring(self, robot: str) -> Callable[[], Iterable[tuple[str, Sequence[int]]]]:
        """Return a function that measures on one robot, once per tick, what is not fed."""
        measured_ns = -1

        def measure() -> Iterable[tuple[str, Sequence[int]]]:
            nonlocal measured_ns
            if measured_ns == self.world.now_ns or robot not in self._devices.present:
                return ()
            measured_ns = self.world.now_ns
            readings = ((sensor, self.world.read(robot, sensor)) for sensor in self._on_read - self._fed)
            return [(sensor, reading.words) for sensor, reading in readings if reading is not None]

        return measure

    def _update_present_devices(self, *, restart: bool = True) -> None:
        """Update the devices after robots were added or removed; the device of a robot added again restarts."""
        if self._robot_changes == self.world.robot_changes:
            return
        robots, self._robot_changes = self.world.robots, self.world.robot_changes
        present = {name: device for name, device in self.devices.items() if name in robots}
        for name in present:
            if restart and name not in self._devices.present:
                self.hosts[name].restart()
        self._devices.present = present
        self._device_of_robot = [present.get(name) for name in robots]


def _is_question(happened: Input) -> bool:
    """Whether an input changes nothing."""
    return isinstance(happened, MessagesReceived) and all(isinstance(each, QUESTIONS) for each in happened.messages)


def _device_starts(
    robots: Sequence[str],
    programs: Mapping[str, ThymioProgram | DeviceStart] | ThymioProgram | None,
    behaviour: str,
) -> dict[str, DeviceStart]:
    """Return the start of each robot that has a device; robots are numbered in their order.

    Raises KeyError for a program of a robot that is not there.
    """
    if isinstance(programs, ThymioProgram):
        programs = dict.fromkeys(robots, programs)
    for name in programs or {}:
        if name not in robots:
            raise KeyError(f"no robot '{name}', only {', '.join(robots) or 'none'}")
    starts = {}
    for number, name in enumerate(robots, start=1):
        given = (programs or {}).get(name)
        if isinstance(given, DeviceStart):
            starts[name] = given
        elif behaviour or given is not None:
            starts[name] = DeviceStart(number, given, behaviour)
    return starts


def _ticks(seconds: float) -> int:
    return round(seconds * _SECOND_NS / TICK_NS)
