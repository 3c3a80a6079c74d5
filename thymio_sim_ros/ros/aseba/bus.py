"""Schedules the robots of a runtime and passes events between them.

An event waits until its receiver runs, so robots that answer each other cannot starve the rest: after `MAX_ROUNDS`
rounds the remaining work waits for the node's next iteration. In a process of its own the same happens after a slice of
wall time: the node serves messages and services every few milliseconds whatever programs do, and robots run in the
order in which they became ready. Tests in lock-step have no slices, since results must not depend on wall time.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from math import inf

from rclpy.node import Node

from thymio_sim_ros.device.behavior_host import is_internal
from thymio_sim_ros.device.programs.foreign import is_unnamed
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.network import AsebaNetwork, NetworkEvent
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports

__all__ = ["Bus"]

MAX_ROUNDS = 10
"""Rounds in which robots may answer each other's events at once, as in headless runs."""

SLICE_S = 0.005
"""Wall time in each iteration of the node after which no other robot starts to run."""

COMPUTER = 0
"""Sender number of events from ROS."""


class Bus:
    """The Aseba network of one runtime.

    `reaches_all`: an event emitted on one robot's topics is for all robots. `shares_numbers`: other programs have given
    all robots one list of events, so that events without names reach other robots as well.
    """

    def __init__(self, node: Node, robots: Sequence[DeviceEndpoints], messages: MessageReports) -> None:
        """`robots`: all robots of the runtime, at any time."""
        self.reaches_all = True
        self.shares_numbers = False
        self._robots = robots
        self._ready: dict[DeviceEndpoints, None] = {}
        self._is_running = False
        self._slice_end_s: float | None = inf
        """Time after which no other robot starts to run; None: one slice after the next robot starts."""
        self._network = AsebaNetwork(node, self._on_network_event, messages)

    @property
    def has_ready_robots(self) -> bool:
        """Whether robots are ready to run."""
        return bool(self._ready)

    @contextmanager
    def slice(self) -> Iterator[None]:
        """Limit robots inside the context to one slice of wall time, which begins with the first robot."""
        self._slice_end_s = None
        try:
            yield
        finally:
            self._slice_end_s = inf

    def run_until_idle(self, *robots: DeviceEndpoints) -> None:
        """Run these robots, then those that receive their events, until idle, `MAX_ROUNDS` or the end of the slice."""
        self._ready.update(dict.fromkeys(robots))
        if self._is_running:
            return
        if self._slice_end_s is None:
            self._slice_end_s = time.monotonic() + SLICE_S
        self._is_running = True
        try:
            for _ in range(MAX_ROUNDS):
                for robot in list(self._ready):
                    if time.monotonic() >= self._slice_end_s:
                        return
                    del self._ready[robot]
                    robot.run_slice()
                if not self._ready:
                    return
        finally:
            self._is_running = False

    def remove(self, robot: DeviceEndpoints) -> None:
        """Remove a robot from the schedule."""
        self._ready.pop(robot, None)

    def forward(self, sender: DeviceEndpoints, event: str, args: Sequence[int]) -> None:
        """Send an event to all other robots: directly in this runtime, by the network topic elsewhere."""
        if self._is_of_one_robot(sender, event):
            return
        source = sender.device.node_id
        for endpoints in self._robots:
            if endpoints is not sender and endpoints.device.radio == sender.device.radio:
                self._enqueue(endpoints, event, args, source)
        self._network.send(NetworkEvent(event, source, sender.device.radio, tuple(args)))

    def emit(self, endpoints: DeviceEndpoints, event: str, args: Sequence[int]) -> None:
        """Send an event from ROS to all robots that declare it, or only to this one; too many values are rejected."""
        reaches_all = self.reaches_all and not self._is_of_one_robot(endpoints, event)
        robots = (
            [robot for robot in self._robots if robot.device.radio == endpoints.device.radio]
            if reaches_all
            else [endpoints]
        )
        sizes = {robot: _size(robot, event) for robot in robots}
        fits = {robot: size for robot, size in sizes.items() if size is not None and len(args) <= size}
        too_small = [size for size in sizes.values() if size is not None and len(args) > size]
        if is_internal(event):
            endpoints.reject_event(event, "internal events stay in the robot")
        elif too_small:
            endpoints.reject_event(event, f"found {len(args)} values, expected at most {min(too_small)}")
        elif not fits and not (reaches_all and self._network.has_others):
            endpoints.reject_event(event, f"the program declares {_declared(endpoints)}")
        else:
            for robot, size in fits.items():
                robot.receive_event(event, [*args, *[0] * (size - len(args))], source=COMPUTER)
            for robot in fits:
                self.run_until_idle(robot)
            if reaches_all:
                self._network.send(NetworkEvent(event, COMPUTER, endpoints.device.radio, tuple(args)))

    def _is_of_one_robot(self, endpoints: DeviceEndpoints, event: str) -> bool:
        return not self.shares_numbers and is_unnamed(endpoints.program, event)

    def _on_network_event(self, event_message: NetworkEvent) -> None:
        for endpoints in self._robots:
            size = _size(endpoints, event_message.event)
            if size is None or endpoints.device.radio != event_message.radio:
                continue
            args = event_message.args[:size] + (0,) * (size - len(event_message.args))
            self._enqueue(endpoints, event_message.event, args, event_message.source)
        if self._ready:
            self.run_until_idle(next(iter(self._ready)))

    def _enqueue(self, endpoints: DeviceEndpoints, event: str, args: Sequence[int], source: int) -> None:
        if not is_internal(event) and endpoints.receive_event(event, args, source=source):
            self._ready[endpoints] = None


def _size(endpoints: DeviceEndpoints, event: str) -> int | None:
    return dict(endpoints.program.events).get(event)


def _declared(endpoints: DeviceEndpoints) -> str:
    events = [event for event, _ in endpoints.program.events if not is_internal(event)]
    return ", ".join(events) or "no events"
