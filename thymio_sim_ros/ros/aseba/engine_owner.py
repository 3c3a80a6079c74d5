"""Programs on the robots of a simulator in the same process: its engine runs them, tick by tick."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence, Set

from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.robot_device import RobotHost, RobotNode
from thymio_sim_ros.engine.devices import SentMessages
from thymio_sim_ros.engine.inputs import ProgramInput
from thymio_sim_ros.ros.simulator.world_runner import WorldRunner

__all__ = ["EngineOwner"]


class EngineOwner:
    """The engine of a simulator as the owner of devices. Only for the thread of the simulator's executor."""

    def __init__(self, runner: WorldRunner, publish: Callable[[], None]) -> None:
        """`publish` publishes what the devices did in their last run."""
        self._runner, self._publish = runner, publish

    @property
    def hosts(self) -> Mapping[str, RobotHost]:
        """The selection of each robot's program."""
        return self._runner.engine.hosts

    @property
    def nodes(self) -> Mapping[str, RobotNode]:
        """Each robot as a node of an Aseba network."""
        return self._runner.engine.nodes

    @property
    def robots(self) -> Set[str]:
        """The robots that are in the world."""
        return self._runner.world.robots.keys()

    @property
    def is_replaying(self) -> bool:
        """Whether a log says which programs run."""
        return self._runner.is_replaying

    @property
    def runs(self) -> int:
        """Number of times that the devices of the present engine have run."""
        return self._runner.engine.runs

    @property
    def ran(self) -> Set[str]:
        """The robots that ran last."""
        return self._runner.engine.ran

    @property
    def emitted(self) -> Sequence[tuple[str, EmittedEvent]]:
        """The events that they emitted, as (robot, event)."""
        return self._runner.engine.emitted

    def pop_sent(self) -> list[SentMessages]:
        """Return and clear the messages for clients, in order."""
        return self._runner.engine.pop_sent()

    def apply(self, happened: ProgramInput) -> None:
        """Execute deferred ticks, apply an input, and publish what comes of it."""
        self._runner.catch_up()
        self._runner.engine.apply(happened)
        self._publish()
