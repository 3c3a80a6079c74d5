"""A robot of ours behind the Aseba server, without ROS and without a world: it lives in the thread of the server."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from typing import TypeVar

from aseba_vm.protocol import Message
from tests.patience import PATIENCE_S, until
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_node import NetworkNode
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.network.hub import Network
from thymio_sim_ros.network.servers import NetworkServers
from thymio_sim_ros.network.settings import NetworkSettings
from thymio_sim_ros.sim.commands import Command

T = TypeVar("T")

TICK_S = 0.01


class ServedRobot:
    """The robot, its port, and the commands that its actuators got. Its time is wall time."""

    def __init__(self, layout: str = "thymio", number: int = 1, port: int = 0) -> None:
        self.warnings: list[str] = []
        self.commands: list[Command] = []
        settings = NetworkSettings(aseba_port=port, is_announced=False)
        self._thread = NetworkServers(settings, warn=self.warnings.append, info=lambda _text: None)
        self._host = BehaviorHost(AsebaDevice(node_id=number, options=DeviceOptions(layout)))
        self._nodes = _Nodes(self._host, self.commands)
        self._network = Network("robot", self._nodes)
        self._nodes.deliver = self._network.deliver
        self._thread.call(self._thread.hub.add, self._network)
        self._thread.call(self._nodes.start)
        self.port = until(lambda: self._thread.ports, lambda: self.warnings)["robot"]

    def do(self, function: Callable[[AsebaDevice], T]) -> T:
        """Call a function with the device in its thread, let the device run, and return the value."""
        return self._in_thread(lambda: self._nodes.do(function))

    def feed(self, sensor: str, *words: int) -> None:
        """Feed a reading."""
        self.do(lambda device: device.feed(sensor, words))

    def variable(self, name: str) -> tuple[int, ...]:
        """A variable of the robot."""
        return self.do(lambda device: device.variables.get(name))

    def disconnect(self) -> None:
        """Disconnect all clients, and listen no more."""
        self._thread.call(self._thread.hub.remove, self._network)

    def close(self) -> None:
        """End everything."""
        self._thread.close()
        assert self.warnings == []

    def _in_thread(self, function: Callable[[], T]) -> T:
        done: Future[T] = Future()

        def call() -> None:
            try:
                done.set_result(function())
            except BaseException as error:
                done.set_exception(error)

        self._thread.call(call)
        return done.result(PATIENCE_S)


class _Nodes:
    """The nodes of the network: one device, in the thread of the server."""

    def __init__(self, host: BehaviorHost, commands: list[Command]) -> None:
        self._device, self._node, self._commands = host.device, NetworkNode(host), commands
        self.deliver: Callable[..., None] = lambda *_arguments: None

    def start(self) -> None:
        """Let the device run from time to time."""
        self._run()
        asyncio.get_running_loop().call_later(TICK_S, self.start)

    def do(self, function: Callable[[AsebaDevice], T]) -> T:
        """Call a function with the device and let it run."""
        value = function(self._device)
        self._run()
        return value

    def connect(self, client: int) -> None:
        self._node.connect(client)

    def disconnect(self, client: int) -> None:
        self._node.disconnect(client)

    def is_full(self, _client: int) -> bool:
        return False

    def send(self, client: int, messages: Sequence[Message]) -> None:
        for message in messages:
            replies = self._node.handle(client, message)
            self.deliver(self._node.pop_messages())
            self.deliver(replies, client)
        self._node.install_bytecode()
        self._run()

    def _run(self) -> None:
        self._device.advance(time.monotonic_ns())
        self._device.run(5000)
        self._commands += self._device.pop_commands()
        self._device.pop_events()
        self.deliver(self._node.pop_messages())
