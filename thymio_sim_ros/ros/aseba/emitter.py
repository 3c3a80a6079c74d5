"""Passes events between ROS and programs: emitted on a robot's topics, and between runtimes in different processes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rclpy.node import Node

from thymio_sim_ros.device.behavior_host import is_internal
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.foreign import is_unnamed
from thymio_sim_ros.engine.inputs import EventSent
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.network import AsebaNetwork, NetworkEvent
from thymio_sim_ros.ros.aseba.program_owner import ProgramOwner
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["Emitter"]

COMPUTER = 0
"""Sender number of events from ROS."""


class Emitter:
    """Sends events to the programs of a runtime.

    `reaches_all`: an event emitted on one robot's topics is for all robots. `shares_numbers`: see `RunStart`.
    """

    def __init__(
        self, node: Node, owner: ProgramOwner, robots: Sequence[DeviceEndpoints], messages: MessageReports
    ) -> None:
        """`robots`: all robots of the runtime, at any time; `messages` collects the reasons of rejected events."""
        self.reaches_all = True
        self.shares_numbers = False
        self._owner, self._robots = owner, robots
        self._network = AsebaNetwork(node, self._on_network_event, messages)

    def emit(self, endpoints: DeviceEndpoints, event: str, args: Sequence[int]) -> None:
        """Send an event from ROS to all robots that declare it, or only to this one; too many values are rejected."""
        reaches_all = self.reaches_all and not self._is_of_one_robot(endpoints, event)
        robots = self._on_radio(endpoints.device.radio) if reaches_all else [endpoints]
        sizes = {robot.robot: _size(robot, event) for robot in robots}
        fits = [robot for robot, size in sizes.items() if size is not None and len(args) <= size]
        too_small = [size for size in sizes.values() if size is not None and len(args) > size]
        if is_internal(event):
            endpoints.reject_event(event, "internal events stay in the robot")
        elif too_small:
            endpoints.reject_event(event, f"found {len(args)} values, expected at most {min(too_small)}")
        elif not fits and not (reaches_all and self._network.has_others):
            endpoints.reject_event(event, f"the program declares {_declared(endpoints)}")
        else:
            if fits:
                self._owner.apply(EventSent(tuple(fits), event, tuple(args), COMPUTER))
            if reaches_all:
                self._network.send(NetworkEvent(event, COMPUTER, endpoints.device.radio, tuple(args)))

    def forward(self, sender: DeviceEndpoints, events: Iterable[EmittedEvent]) -> None:
        """Send events that a robot has emitted to the runtimes of other processes."""
        for event in events:
            if not self._is_of_one_robot(sender, event.name):
                device = sender.device
                self._network.send(NetworkEvent(event.name, device.node_id, device.radio, tuple(event.args)))

    def _on_network_event(self, received: NetworkEvent) -> None:
        if is_internal(received.event):
            return
        sizes = {robot.robot: _size(robot, received.event) for robot in self._on_radio(received.radio)}
        for robot, size in sizes.items():
            if size is not None:
                self._owner.apply(EventSent((robot,), received.event, received.args[:size], received.source))

    def _on_radio(self, radio: tuple[int, int]) -> list[DeviceEndpoints]:
        return [robot for robot in self._robots if robot.device.radio == radio]

    def _is_of_one_robot(self, endpoints: DeviceEndpoints, event: str) -> bool:
        return not self.shares_numbers and is_unnamed(endpoints.program, event)


def _size(endpoints: DeviceEndpoints, event: str) -> int | None:
    return dict(endpoints.host.program.events).get(event)


def _declared(endpoints: DeviceEndpoints) -> str:
    events = [event for event, _ in endpoints.program.events if not is_internal(event)]
    return ", ".join(events) or "no events"
