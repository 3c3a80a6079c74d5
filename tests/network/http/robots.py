"""Networks of simulated robots in memory: messages go to the real devices and back, without ROS and simulator."""

from __future__ import annotations

import asyncio
import threading
from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from aseba_vm.protocol import Message
from tests.patience import PATIENCE_S
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_node import NetworkNode
from thymio_sim_ros.network.http.server import HttpServer
from thymio_sim_ros.network.hub import Hub, Network
from thymio_sim_ros.network.settings import NetworkSettings

BUDGET = 5000
CLIENT = 1


class Robot:
    """One robot on a network of its own, with one client."""

    def __init__(self, node_id: int = 1) -> None:
        self.device = AsebaDevice(node_id=node_id)
        self.node = NetworkNode(BehaviorHost(self.device))
        self.node.connect(CLIENT)
        self.inbox: deque[Message] = deque()

    def run(self) -> list[Message]:
        """Process what has arrived, then run the program; return all messages for the client."""
        found = []
        while self.inbox:
            found += self.node.handle(CLIENT, self.inbox.popleft())
            found += self.node.pop_messages()
        self.device.run(BUDGET)
        return found + self.node.pop_messages()


class Robots:
    """The node of a network of the hub. Its robot runs in the event loop whenever there is something to process."""

    def __init__(self, name: str = "") -> None:
        self.network = Network(name, self)
        self._robot = Robot()

    def connect(self, client: int) -> None:
        """Add a client; the robot has one in any case."""

    def disconnect(self, client: int) -> None:
        """Remove a client."""

    def send(self, client: int, messages: Sequence[Message]) -> None:
        """Process messages in the next iteration of the loop."""
        self._robot.inbox.extend(messages)
        asyncio.get_running_loop().call_soon(self._run)

    def is_full(self, client: int) -> bool:
        """Never."""
        return False

    def _run(self) -> None:
        if messages := self._robot.run():
            self.network.deliver(messages)


class ServerThread:
    """An HTTP server with these robots, in a thread. `port` is its port, `problems` what it has reported."""

    def __init__(
        self, names: Sequence[str] = ("",), *, port: int = 0, address: str = "localhost", tokens: Tokens | None = None
    ) -> None:
        self.problems: list[tuple[str, str]] = []
        self.names = names
        self._settings = NetworkSettings(http_port=port, address=address)
        self._tokens = tokens or Tokens()
        self._loop = asyncio.new_event_loop()
        self._stop = asyncio.Event()
        self._is_ready = threading.Event()
        self._thread = threading.Thread(target=self._loop.run_until_complete, args=(self._serve(),), daemon=True)
        self._thread.start()
        assert self._is_ready.wait(PATIENCE_S)

    async def _serve(self) -> None:
        self.hub = Hub()
        self.robots = [Robots(name) for name in self.names]
        for robot in self.robots:
            self.hub.add(robot.network)
        self.server = HttpServer(
            self.hub, self._settings, lambda *problem: self.problems.append(problem), tokens=self._tokens
        )
        self.server.start()
        self.port = self.server.port
        self._is_ready.set()
        await self._stop.wait()
        await self.server.close()

    def call(self, function: Callable[[], Any]) -> Any:
        """The result of a function that is called in the thread of the server."""

        async def called() -> Any:
            return function()

        return asyncio.run_coroutine_threadsafe(called(), self._loop).result(PATIENCE_S)

    def end(self) -> None:
        """End server and thread; a second call has no effect."""
        if not self._loop.is_closed():
            self._loop.call_soon_threadsafe(self._stop.set)
            self._thread.join(PATIENCE_S)
            assert not self._thread.is_alive()
            self._loop.close()
