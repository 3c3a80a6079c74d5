"""World and devices in lock-step, in one thread, without ROS: tests, batch runs, benchmarks.

One step: (1) the world ticks; (2) each robot's device is fed its readings and told the time; (3) the devices run, in
the order of the playground, and the events that one emits reach the others, until nobody has anything left to hear;
(4) the commands go to the world, where they take effect in the next tick. All devices are on one Aseba bus: who emits
does not hear himself. The same playground, programs and seed give the same run bit for bit.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.device import AsebaDevice, EmittedEvent
from thymio_sim_ros.device.firmware.behavior_host import BehaviorHost
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.runlog.run_log import RunLog
from thymio_sim_ros.sim.commands import MOTOR_MODELS, Command, PressButton
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.world import StepResult, World

__all__ = ["Runner"]

BUDGET = 5000
"""Instructions of a device per round of a tick; a handler that needs more goes on in the next."""

MAX_ROUNDS = 10
"""Times per tick that robots may answer each other's events; what is left goes on in the next tick."""

_SECOND_NS = 1_000_000_000


class Runner:
    """A world, and a device for each robot that has a program or a behaviour.

    `emitted` holds the events that the last step brought, as (robot, event), in order.
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
    ) -> None:
        """One program for all robots, or one by robot's name; KeyError for a name that is not there.

        With a `behaviour`, such as "menu", every robot is switched on with that, and a program waits in its menu.
        SdCardError, SettingsError: a folder of the options cannot be used. A `log` follows the world from the start.
        """
        self.world = World(playground, seed=seed, noise=noise, motor_model=motor_model, proximity_model=proximity_model)
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
        self.hosts = {name: BehaviorHost(device) for name, device in self.devices.items()}
        for name, host in self.hosts.items():
            program = (programs or {}).get(name)
            if behaviour:
                host.start(behaviour, program)
            elif program is not None:
                host.load(program)
        self._bound = frozenset(bindings.sensor_names())
        self.emitted: list[tuple[str, EmittedEvent]] = []
        self._present: dict[str, AsebaDevice] = {}
        """Devices of the robots that are in the world; the others rest."""
        self._start()

    @property
    def now_ns(self) -> int:
        """Simulated time."""
        return self.world.now_ns

    def step(self) -> StepResult:
        """One tick of the world, and what the programs make of it."""
        result = self.world.step()
        self._update_present_devices()
        bound, devices = self._bound, self._present
        for robot, sensor, reading in result.readings:
            if sensor in bound and robot in devices:
                devices[robot].feed(sensor, reading.words)
        for device in devices.values():
            device.advance(result.now_ns)
        self._run_devices()
        return result

    def run(self, seconds: float) -> None:
        """So many simulated seconds."""
        for _ in self.steps(seconds):
            pass

    def steps(self, seconds: float) -> Iterator[StepResult]:
        """So many simulated seconds, tick by tick."""
        for _ in range(round(seconds * _SECOND_NS / TICK_NS)):
            yield self.step()

    def until(self, condition: Callable[[], bool], seconds: float) -> bool:
        """Run until the condition holds, at most so many simulated seconds; whether it held."""
        end_ns = self.now_ns + round(seconds * _SECOND_NS)
        while not condition():
            if self.now_ns >= end_ns:
                return False
            self.step()
        return True

    def post(self, robot: str, command: Command) -> None:
        """A command for a robot; it takes effect in the next tick."""
        self.world.post(robot, command)

    def press(self, robot: str, button: str, *, pressed: bool = True) -> None:
        """Put a finger on a button, or take it off."""
        self.post(robot, PressButton(button, pressed))

    def load(self, robot: str, program: ThymioProgram) -> None:
        """Give a robot that has a device another program, which begins now; KeyError: it has none."""
        self.hosts[robot].load(program)
        self._update_present_devices()
        self._run_devices()

    def reset(self) -> None:
        """World, noise and programs as at the start."""
        self.world.reset()
        for host in self.hosts.values():
            host.restart()
        self._start()

    def _start(self) -> None:
        self._present = dict(self.devices)
        for device in self._present.values():
            device.advance(self.now_ns)
        self._run_devices()

    def _update_present_devices(self) -> None:
        """Robots come and go; one that is back begins anew."""
        robots = self.world.robots
        if len(self._present) == len(self.devices) and self.devices.keys() <= robots.keys():
            return
        present = {name: device for name, device in self.devices.items() if name in robots}
        for name in present:
            if name not in self._present:
                self.hosts[name].restart()
        self._present = present

    def _run_devices(self) -> None:
        self.emitted.clear()
        for _ in range(MAX_ROUNDS):
            for device in self._present.values():
                device.run(BUDGET)
            senders = [name for name, device in self._present.items() if device.has_emitted]
            if sum(self._forward_events(name, self.hosts[name]) for name in senders) == 0:
                break
        for name, device in self._present.items():
            for command in device.pop_commands():
                self.world.post(name, command)

    def _forward_events(self, name: str, sender: BehaviorHost) -> int:
        """Let the others hear what a device emitted, or change its program; how many have something new to do."""
        running = sender.program
        events = sender.pop_events()
        woken = int(sender.program is not running)
        for event in events:
            self.emitted.append((name, event))
            for device in self._present.values():
                if device is not sender.device and device.receives_from(sender.device) and device.declares(event.name):
                    device.receive_event(event.name, event.args, source=sender.device.node_id)
                    woken += 1
        return woken
