"""Programs on robots outside of this process: the runtime runs them by the clock of its node."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set

from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.robot_device import RobotHost, RobotNode
from thymio_sim_ros.engine.devices import Devices, SentMessages
from thymio_sim_ros.engine.inputs import DevicesAdded, ProgramInput
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.clock import NEVER_NS

__all__ = ["StandaloneOwner"]


class StandaloneOwner:
    """Devices that the runtime itself owns: their readings are fed, and their commands go to `send`."""

    def __init__(
        self,
        now_ns: Callable[[], int],
        *,
        send: Callable[[str, Command], None],
        publish: Callable[[], None],
    ) -> None:
        """`now_ns` returns the time of the node; `publish` publishes the results of the last run of the devices."""
        self.devices = Devices()
        self._now_ns, self._send, self._publish = now_ns, send, publish

    @property
    def hosts(self) -> Mapping[str, RobotHost]:
        """The selection of each robot's program."""
        return self.devices.hosts

    @property
    def nodes(self) -> Mapping[str, RobotNode]:
        """Each robot as a node of an Aseba network."""
        return self.devices.nodes

    @property
    def robots(self) -> Set[str]:
        """All robots."""
        return self.devices.hosts.keys()

    @property
    def is_replaying(self) -> bool:
        """Whether a log says which programs run: never."""
        return False

    @property
    def runs(self) -> int:
        """Number of times that the devices have run."""
        return self.devices.runs

    @property
    def ran(self) -> Set[str]:
        """The robots that ran last."""
        return self.devices.ran

    @property
    def emitted(self) -> Sequence[tuple[str, EmittedEvent]]:
        """The events that they emitted, as (robot, event)."""
        return self.devices.emitted

    @property
    def wait_s(self) -> float:
        """Time in s until a device has work, by the clock of the node; 0 if it has work now."""
        due_ns = min((host.device.due.ns for host in self.devices.hosts.values()), default=NEVER_NS)
        return max(0.0, (due_ns - self._now_ns()) * 1e-9)

    def pop_sent(self) -> list[SentMessages]:
        """Return and clear the messages for clients, in order."""
        return self.devices.pop_sent()

    def feed(self, robot: str, sensor: str, words: Sequence[int]) -> None:
        """Store a reading and run the devices. Raises ValueError for a wrong number of words."""
        self.devices.hosts[robot].device.feed(sensor, words)
        self.run()

    def restart(self) -> None:
        """Restart all programs."""
        for host in self.devices.hosts.values():
            host.restart()
        self.run()

    def apply(self, happened: ProgramInput) -> None:
        """Apply an input, and run the devices."""
        if isinstance(happened, DevicesAdded):
            self.devices.create(happened, alone=len(self.robots | happened.devices.keys()) == 1)
            self.devices.begin(happened.devices)
        else:
            self.devices.apply(happened)
        self.run()

    def run(self) -> None:
        """Run the devices that are due."""
        devices = self.devices
        devices.present = {name: host.device for name, host in devices.hosts.items()}
        for robot, command in devices.run(self._now_ns()):
            self._send(robot, command)
        self._publish()
