"""World and devices in lock-step, in one thread, without ROS: tests, batch runs, benchmarks.

One step: (1) the world ticks; (2) each device gets its readings; (3) the devices that are due run in the order of the
playground, and emitted events are forwarded to the other devices until none is pending; (4) the commands are posted to
the world and take effect in the next tick. All devices share one Aseba bus; an event is not sent back to its sender.
The same playground, programs and seed give the same run bit for bit, whatever is read.

What measures in every tick without noise or memory, such as the speeds of the motors, is measured when a program runs
or its variables are read (`AsebaDevice.measure_on_read`), unless a program handles its event.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence

from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.engine.run_log import RunLog
from thymio_sim_ros.sim.commands import MOTOR_MODELS, Command, PressButton
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.plugin_api.reading_table import ReadingTable
from thymio_sim_ros.sim.sensors import all_sensors
from thymio_sim_ros.sim.world import StepResult, World

__all__ = ["Engine"]

BUDGET = 5000
"""Instructions of a device per round of a tick; a longer handler continues in the next."""

MAX_ROUNDS = 10
"""Rounds per tick in which robots may react to events of others; the rest continues in the next tick."""

_SECOND_NS = 1_000_000_000


class Engine:
    """A world, and a device for each robot that has a program or a behaviour.

    `emitted` has the events of the last step as (robot, event), in order.
    """

    def __init__(
        self,
        playground: Playground,
        programs: Mapping[str, ThymioProgram] | ThymioProgram | None = None,
        *,
        behaviour: str = "",
        options: DeviceOptions = DEFAULTS,
        motor_model: str = MOTOR_MODELS[0],
        proximity_model: str = PROXIMITY_MODELS[0],
        seed: int = 0,
        noise: bool = True,
        log: RunLog | None = None,
        ground: Ground | None = None,
    ) -> None:
        """Create the world and a device for each robot with a program: one program for all, or one by robot name.

        With a `behaviour`, such as "menu", every robot is switched on with that, and a program waits in its menu.
        SdCardError, SettingsError: a folder of the options cannot be used. A `log` follows the world from the start.
        A `ground` of the playground that exists already, from a run that has ended, need not be painted again.
        """
        self.world = World(
            playground,
            seed=seed,
            noise=noise,
            motor_model=motor_model,
            proximity_model=proximity_model,
            ground=ground,
        )
        if log is not None:
            log.begin(playground.name, self.world)
        if isinstance(programs, ThymioProgram):
            programs = dict.fromkeys(self.world.robots, programs)
        numbers = {name: number for number, name in enumerate(self.world.robots, start=1)}
        wanted = self.world.robots if behaviour else programs or {}
        alone = len(numbers) == 1
        self.devices = {
            name: AsebaDevice(node_id=numbers[name], options=options.for_robot(name, alone=alone)) for name in wanted
        }
        self._robot_changes = -1
        """`world.robot_changes` when `_present` was updated."""
        self._present: dict[str, AsebaDevice] = {}
        """Devices of the robots that are in the world; the others do not run."""
        self._device_of_robot: list[AsebaDevice | None] = []
        """The device of each robot in the world, in its order."""
        self._bound = frozenset(bindings.sensor_names()) if self.devices else frozenset()
        self._on_read = self._bound & {
            sensor.name for sensor in all_sensors() if sensor.is_stateless and sensor.period_ns <= TICK_NS
        }
        """Sensors that measure when variables are read, unless a program handles their events."""
        self._fed = self._bound
        """Sensors whose readings are fed to the devices."""
        self._wanted_events: list[frozenset[int]] = []
        """The local events that the devices wanted when `_fed` was chosen."""
        self.emitted: list[tuple[str, EmittedEvent]] = []
        for name, device in self.devices.items():
            device.measure_on_read(self._on_read, self._measuring(name))
        self.hosts = {name: BehaviorHost(device) for name, device in self.devices.items()}
        for name, host in self.hosts.items():
            program = (programs or {}).get(name)
            if behaviour:
                host.start(behaviour, program)
            elif program is not None:
                host.load(program)
        self._start()

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        return self.world.now_ns

    def step(self, sensors: Collection[str] | None = None) -> StepResult:
        """Run one tick of the world and of the programs.

        `sensors`: names of the sensors whose readings the result must have; None: all. See `World.step`.
        """
        now_ns = self.world.now_ns
        for device in self._present.values():
            if device.due.ns <= now_ns:  # as it is after another program was loaded
                self._choose_fed()
                break
        wanted = sensors if sensors is None else self._fed if not sensors else self._fed.union(sensors)
        result = self.world.step(wanted)
        if self.devices:
            if self._robot_changes != self.world.robot_changes:
                self._update_present_devices()
            if isinstance(result.readings, ReadingTable):
                self._feed(result.readings, result.now_ns)
            self._run_devices()
        return result

    def _feed(self, table: ReadingTable, now_ns: int) -> None:
        for sensor, readings in table.columns:
            if sensor in self._bound:
                for device, reading in zip(self._device_of_robot, readings, strict=True):
                    if device is not None and reading is not None:
                        device.feed(sensor, reading.words, now_ns)

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

    def post(self, robot: str, command: Command) -> None:
        """Post a command for a robot; it takes effect in the next tick."""
        self.world.post(robot, command)

    def press(self, robot: str, button: str, *, pressed: bool = True) -> None:
        """Press or release a button."""
        self.post(robot, PressButton(button, pressed))

    def load(self, robot: str, program: ThymioProgram) -> None:
        """Load another program, which starts now. Raises KeyError for a robot without a device."""
        self._update_present_devices()
        self.devices[robot].end_tick(self.now_ns)
        self.hosts[robot].load(program)
        self._choose_fed()
        self._run_devices()

    def reset(self) -> None:
        """Reset world, noise and programs to the start."""
        self.world.reset()
        for host in self.hosts.values():
            host.restart()
        self._start()

    def _start(self) -> None:
        self._present = dict(self.devices)
        for device in self._present.values():
            device.advance(self.now_ns)
        self._run_devices()
        self._choose_fed()

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
            if measured_ns == self.world.now_ns or robot not in self._present:
                return ()
            measured_ns = self.world.now_ns
            readings = ((sensor, self.world.read(robot, sensor)) for sensor in self._on_read - self._fed)
            return [(sensor, reading.words) for sensor, reading in readings if reading is not None]

        return measure

    def _update_present_devices(self) -> None:
        """Update the devices after robots were added or removed; the device of a robot added again restarts."""
        robots, self._robot_changes = self.world.robots, self.world.robot_changes
        present = {name: device for name, device in self.devices.items() if name in robots}
        for name in present:
            if name not in self._present:
                self.hosts[name].restart()
        self._present = present
        self._device_of_robot = [present.get(name) for name in robots]

    def _run_devices(self) -> None:
        """Run the devices that are due, and those that receive their events."""
        self.emitted.clear()
        now_ns, due, advanced = self.world.now_ns, [], set()
        for _ in range(MAX_ROUNDS):
            due = [(name, device) for name, device in self._present.items() if device.due.ns <= now_ns]
            if not due:
                return
            for name, device in due:
                if name not in advanced:
                    advanced.add(name)
                    device.advance(now_ns)
                device.run(BUDGET)
            senders = [name for name, device in due if device.has_emitted]
            if sum(self._forward_events(name, self.hosts[name]) for name in senders) == 0:
                break
        for name, device in due:
            for command in device.pop_commands():
                self.world.post(name, command)

    def _forward_events(self, name: str, sender: BehaviorHost) -> int:
        """Forward the emitted events of a device, or change its program; return how many devices have new work."""
        running = sender.program
        events = sender.pop_events()
        woken = int(sender.program is not running)
        if woken:
            self._choose_fed()
        for event in events:
            self.emitted.append((name, event))
            for device in self._present.values():
                if device is not sender.device and device.receives_from(sender.device) and device.declares(event.name):
                    device.receive_event(event.name, event.args, source=sender.device.node_id)
                    woken += 1
        return woken


def _ticks(seconds: float) -> int:
    return round(seconds * _SECOND_NS / TICK_NS)
