"""How the robots of a runtime share the machine and the air: turns, and events from one to the others.

An event waits for its hearer's turn, so that robots that answer each other cannot starve the rest: after some rounds
what is left waits for the node's next turn. So does, in a process of our own, what is left after a slice of wall time:
the node serves messages and services every few milliseconds whatever programs do, and robots take their turns in the
order in which they began to wait. Tests in lock-step have no slices, since their results must not depend on wall time.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from math import inf

from rclpy.node import Node

from thymio_sim_ros.device.firmware.behavior_host import is_internal
from thymio_sim_ros.ros.aseba.device_endpoints import DevicePorts
from thymio_sim_ros.ros.aseba.network import AsebaNetwork, Telegram

__all__ = ["Bus"]

MOST_ROUNDS = 10
"""Times that robots may answer each other's events at once (as in the runner)."""

SLICE_S = 0.005
"""Wall time in each turn of the node after which no other robot begins its turn."""

COMPUTER = 0
"""Number of the sender of what comes from ROS."""


class Bus:
    """The Aseba network of one runtime. `reaches_all`: what ROS emits on one robot's topics is for all."""

    def __init__(
        self, node: Node, robots: Callable[[], Sequence[DevicePorts]], told: Callable[[DevicePorts], None]
    ) -> None:
        self.reaches_all = True
        self._robots = robots
        self._told = told
        self._woken: dict[DevicePorts, None] = {}
        self._is_settling = False
        self._slice_end_s: float | None = inf
        """When no other robot begins its turn; None: a slice after the next one begins."""
        self._network = AsebaNetwork(node, self._hear_others)

    @property
    def has_waiting(self) -> bool:
        """Whether robots wait for a turn."""
        return bool(self._woken)

    @contextmanager
    def slice(self) -> Iterator[None]:
        """Meanwhile robots take turns for a slice of wall time, which begins with the first of them."""
        self._slice_end_s = None
        try:
            yield
        finally:
            self._slice_end_s = inf

    def settle(self, *robots: DevicePorts) -> None:
        """Let robots take their turns, then those that they wake, for some rounds and until the slice ends."""
        self._woken.update(dict.fromkeys(robots))
        if self._is_settling:
            return
        if self._slice_end_s is None:
            self._slice_end_s = time.monotonic() + SLICE_S
        self._is_settling = True
        try:
            for _ in range(MOST_ROUNDS):
                for robot in list(self._woken):
                    if time.monotonic() >= self._slice_end_s:
                        return
                    del self._woken[robot]
                    robot.turn()
                if not self._woken:
                    return
        finally:
            self._is_settling = False

    def forget(self, robot: DevicePorts) -> None:
        """A robot goes."""
        self._woken.pop(robot, None)

    def pass_on(self, sender: DevicePorts, event: str, args: Sequence[int]) -> None:
        """Robots of one runtime hear each other directly, others by the network's topic; nobody hears himself."""
        source = sender.device.node_id
        for ports in self._robots():
            if ports is not sender and ports.device.receives_from(sender.device):
                self._let_hear(ports, event, args, source)
        self._network.send(Telegram(event, source, sender.device.services.network, tuple(args)))

    def emit(self, ports: DevicePorts, event: str, args: Sequence[int]) -> None:
        """An event from ROS reaches every robot that declares it, or only this one; too much data is refused."""
        robots = (
            [robot for robot in self._robots() if robot.device.receives_from(ports.device)]
            if self.reaches_all
            else [ports]
        )
        sizes = {robot: _size(robot, event) for robot in robots}
        fits = {robot: size for robot, size in sizes.items() if size is not None and len(args) <= size}
        too_small = [size for size in sizes.values() if size is not None and len(args) > size]
        about = f"event {event}"
        if is_internal(event):
            ports.warn(about, "refused: it stays inside the robot")
        elif too_small:
            ports.warn(about, f"refused: {len(args)} values found, expected at most {min(too_small)}")
        elif not fits and not (self.reaches_all and self._network.has_others):
            ports.warn(about, f"refused: the program declares {_declared(ports)}")
        else:
            for robot, size in fits.items():
                robot.hear(event, [*args, *[0] * (size - len(args))], source=COMPUTER)
            for robot in fits:
                self.settle(robot)
            if self.reaches_all:
                self._network.send(Telegram(event, COMPUTER, ports.device.services.network, tuple(args)))

    def told(self, ports: DevicePorts) -> None:
        """The status of a robot is another."""
        self._told(ports)

    def _hear_others(self, telegram: Telegram) -> None:
        for ports in self._robots():
            size = _size(ports, telegram.event)
            if size is None or ports.device.services.network != telegram.radio:
                continue
            args = telegram.args[:size] + (0,) * (size - len(telegram.args))
            self._let_hear(ports, telegram.event, args, telegram.source)
        if self._woken:
            self.settle(next(iter(self._woken)))

    def _let_hear(self, ports: DevicePorts, event: str, args: Sequence[int], source: int) -> None:
        if not is_internal(event) and ports.hear(event, args, source=source):
            self._woken[ports] = None


def _size(ports: DevicePorts, event: str) -> int | None:
    return dict(ports.program.events).get(event)


def _declared(ports: DevicePorts) -> str:
    events = [event for event, _ in ports.program.events if not is_internal(event)]
    return ", ".join(events) or "no events"
