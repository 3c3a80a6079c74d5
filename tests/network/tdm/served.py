"""A device manager on free ports of this computer, in a thread, with nodes in memory."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field

from aseba_vm.protocol.messages import Message
from tests.network.tdm.machine_node import MachineNode
from tests.patience import PATIENCE_S
from thymio_sim_ros.network.hub import Hub, Network
from thymio_sim_ros.network.settings import NetworkSettings
from thymio_sim_ros.network.tdm_server import TdmServer


class MachineNetwork:
    """A network with one node in memory, which executes messages and handlers at once."""

    def __init__(self, node: MachineNode, place: int) -> None:
        self.node = node
        self.network = Network(f"thymio_{place}", self, place=place)

    def connect(self, client: int) -> None:
        """Nothing to do."""

    def disconnect(self, client: int) -> None:
        """Nothing to do."""

    def send(self, client: int, messages: Sequence[Message]) -> None:
        """Execute messages; what the node sends is delivered later, as from another thread."""
        answers = [answer for message in messages for answer in (*self.node.handle(message), *self.node.run())]
        asyncio.get_running_loop().call_soon(self.network.deliver, answers)

    def is_full(self, client: int) -> bool:
        """Never."""
        return False


@dataclass
class Served:
    """The server with its loop, its networks, and what it has reported."""

    server: TdmServer
    loop: asyncio.AbstractEventLoop
    networks: list[MachineNetwork]
    reports: list[tuple[str, str]] = field(default_factory=list)

    @property
    def tcp_port(self) -> int:
        """The TCP port."""
        return self.server.port

    @property
    def ws_port(self) -> int:
        """The WebSocket port."""
        return self.server.ws_port

    def start_event(self, place: int, event: int) -> None:
        """A local event happens on a node; from any thread."""
        found = self.networks[place]
        self.loop.call_soon_threadsafe(lambda: found.network.deliver(found.node.start(event)))


@contextmanager
def served(
    *nodes: MachineNode, allowed_origins: tuple[str, ...] = (), password: str = "", **limits: int
) -> Iterator[Served]:
    """Serve nodes, each alone on its network with the name thymio_<place>."""
    ready = threading.Event()
    found: list[Served] = []
    stop = asyncio.Event()
    settings = NetworkSettings(address="127.0.0.1", tdm_port=0, tdm_ws_port=0, allowed_origins=allowed_origins)

    async def serve() -> None:
        hub, reports = Hub(), []
        networks = [MachineNetwork(node, place) for place, node in enumerate(nodes)]
        server = TdmServer(
            hub, settings, lambda about, text: reports.append((about, text)), password=password, **limits
        )
        server.start()
        for network in networks:
            hub.add(network.network)
        found.append(Served(server, asyncio.get_running_loop(), networks, reports))
        await asyncio.sleep(0)
        ready.set()
        await stop.wait()
        await server.close()

    thread = threading.Thread(target=lambda: asyncio.run(serve()), name="tdm")
    thread.start()
    assert ready.wait(PATIENCE_S)
    try:
        yield found[0]
    finally:
        found[0].loop.call_soon_threadsafe(stop.set)
        thread.join(PATIENCE_S)
        assert not thread.is_alive()
