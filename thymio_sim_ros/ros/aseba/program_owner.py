"""The owner of the devices of a runtime, as their endpoints use it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Protocol

from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.robot_device import RobotHost, RobotNode
from thymio_sim_ros.engine.devices import SentMessages
from thymio_sim_ros.engine.inputs import ProgramInput

__all__ = ["ProgramOwner"]


class ProgramOwner(Protocol):
    """The engine of a simulator in the same process, or the runtime itself.

    Robots have the names of the owner: those of the world, or their ROS names.
    """

    @property
    def hosts(self) -> Mapping[str, RobotHost]:
        """The selection of each robot's program."""

    @property
    def nodes(self) -> Mapping[str, RobotNode]:
        """Each robot as a node of an Aseba network."""

    @property
    def robots(self) -> Set[str]:
        """The robots that are in the world."""

    @property
    def is_replaying(self) -> bool:
        """Whether a log says which programs run."""

    @property
    def runs(self) -> int:
        """Number of times that the devices have run."""

    @property
    def ran(self) -> Set[str]:
        """The robots that ran last."""

    @property
    def emitted(self) -> Sequence[tuple[str, EmittedEvent]]:
        """The events that they emitted, as (robot, event)."""

    def pop_sent(self) -> list[SentMessages]:
        """Return and clear the messages for clients, in order."""

    def apply(self, happened: ProgramInput) -> None:
        """Apply an input now, then publish its results. Raises as `Devices.apply` does."""
