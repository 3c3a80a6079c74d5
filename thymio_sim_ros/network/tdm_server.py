"""The device manager on its sockets: TCP and WebSocket around the conversation, in the event loop of the caller.

No client delays another one for long: a compilation runs on a thread of its own, a client that uses much of the loop's
time is paused, one that does not read gets no more changes of variables, and is disconnected in the end.

Source: docs/spec/aseba-protocol.md section 2.1.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import time
import traceback
from collections.abc import Callable, Coroutine, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from http import HTTPStatus
from socket import SO_SNDBUF, SOL_SOCKET, socket
from uuid import uuid4

from aiohttp import web

from aseba_vm.protocol.messages import Message as AsebaMessage
from thymio_sim_ros.access import AccessCheck, AccessRules, RefusedError, Tokens, Visitor
from thymio_sim_ros.access.attempts import TooManyAttemptsError
from thymio_sim_ros.access.origins import FOXGLOVE_APPS
from thymio_sim_ros.bridge.connections import Connections, ConnectionSlot, Phase
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.bridge.throttle import Throttle
from thymio_sim_ros.network.acceptor import Acceptor
from thymio_sim_ros.network.hub import Connection, Hub, Network
from thymio_sim_ros.network.settings import OFF, NetworkSettings
from thymio_sim_ros.network.tdm.conversation.clients import Closing
from thymio_sim_ros.network.tdm.conversation.device_manager import DeviceManager
from thymio_sim_ros.network.tdm.conversation.handshake import ManagerSettings
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode
from thymio_sim_ros.network.tdm.protocol.constants import NodeType
from thymio_sim_ros.network.tdm.protocol.errors import TdmFrameError
from thymio_sim_ros.network.tdm.protocol.messages import ConnectionHandshake
from thymio_sim_ros.network.tdm.protocol.messages import Message as TdmMessage
from thymio_sim_ros.network.tdm_peers import Peer, Report, TcpPeer, accept_websocket, is_this_computer
from thymio_sim_ros.web.application import Application
from thymio_sim_ros.web.http_connections import HttpConnections

__all__ = ["MAX_CLIENTS", "MAX_UNSENT", "TdmServer"]

MAX_CLIENTS = 32
"""Clients of both ports together."""
MAX_UNSENT = 4 << 20
"""Bytes that wait for a client that does not read; it is disconnected beyond them."""

_PERIOD_S, _IDLE_PERIOD_S = 0.05, 0.5
"""Time between two looks at what is due, with clients and without."""
_SLICE_S = 0.002
"""Processor time after which a client is paused for as long."""
_CONGESTED, _DRAINED = 1 << 18, 1 << 15
"""Bytes that wait for a client, from which and below which it counts as slow and as fast again."""
_KERNEL_BUFFER = 1 << 16
"""Bytes for a client in the kernel; those beyond are counted here."""
_FULL_PAUSE_S = 0.005
"""Time after which a client that had to pause, because messages wait for the robots, is read again."""


class TdmServer:
    """The device manager of the networks of a hub. All methods belong to the thread of the event loop."""

    def __init__(
        self,
        hub: Hub,
        settings: NetworkSettings,
        report: Report,
        opened: Callable[[TdmServer], None] = lambda server: None,
        *,
        password: str = "",
        max_clients: int = MAX_CLIENTS,
        max_unsent: int = MAX_UNSENT,
    ) -> None:
        """Serve nothing until `start`.

        `opened` is called when the ports are open. `password`: what clients on other computers must give; empty:
        nothing.
        """
        self._opened = opened
        self._hub, self._settings, self._report = hub, settings, report
        origins = (*settings.allowed_origins, *FOXGLOVE_APPS)
        self._pages = AccessCheck(AccessRules(allowed_origins=origins), report)
        """Decides about handshakes of WebSockets; the password is in a later message."""
        self._passwords = AccessCheck(AccessRules(Tokens(password)), report)
        self._max_clients, self._max_unsent = max_clients, max_unsent
        self._slots = Connections(max_clients, time.monotonic)
        self._clock_ns = time.time_ns() - time.monotonic_ns()
        self.uuid = uuid4()
        """Its id."""
        self._manager: DeviceManager
        self.port, self.ws_port = OFF, OFF
        """The open ports."""
        self._is_open = False
        self._links: dict[int, Connection] = {}
        """Our connection to each network, by the number that the manager knows."""
        self._network_numbers = itertools.count()
        self._peers: dict[int, Peer] = {}
        self._congested: set[int] = set()
        self._client_numbers = itertools.count(1)
        self._acceptor: Acceptor
        self._websockets: HttpConnections
        """The connections to the WebSocket port."""
        self._tasks: set[asyncio.Task[None]] = set()
        self._compiler = ThreadPoolExecutor(1, "tdm-compiler")
        self._throttle = Throttle(_SLICE_S)
        self._is_delivering = False

    def start(self) -> None:
        """Serve the networks of the hub. Ports that cannot be opened are reported, and nothing is served."""
        settings = self._settings
        tcp: list[socket] = []
        websocket: list[socket] = []
        try:
            if settings.tdm_port != OFF:
                tcp = listen(settings.address, settings.tdm_port)
                websocket = listen(settings.address, settings.tdm_ws_port)
        except (OSError, OverflowError) as error:
            for listener in tcp:
                listener.close()
            self._report("tdm", f"Thymio Device Manager: {getattr(error, 'strerror', None) or error}")
            return
        for listener in (*tcp, *websocket):  # clients inherit it; otherwise the kernel keeps megabytes of old values
            listener.setsockopt(SOL_SOCKET, SO_SNDBUF, _KERNEL_BUFFER)
        if tcp:
            self.port, self.ws_port = tcp[0].getsockname()[1], websocket[0].getsockname()[1]
        manager = ManagerSettings(self.uuid, max(self.ws_port, 0), self._passwords.rules.tokens.full)
        self._manager = DeviceManager(manager, self._now_ns())
        self._hub.follow(self)
        self._acceptor = Acceptor(tcp, self._serve_tcp, self._report_error)
        self._websocket_listeners = websocket
        application = Application()
        application.websockets["/"] = self._handle
        connections = 2 * self._max_clients  # of which half may be in their handshake
        self._websockets = HttpConnections(application.answer, connections, self._report, asyncio.get_running_loop())
        self._websockets.accept(websocket)
        self._run(self._advance())
        self._is_open = True
        self._opened(self)

    async def close(self) -> None:
        """Close ports and connections."""
        if not self._is_open:
            return
        self._is_open = False
        self.port = self.ws_port = OFF
        self._hub.unfollow(self)
        self._acceptor.close()
        for peer in self._peers.values():
            peer.abort()
        for task in self._tasks:
            task.cancel()
        await self._acceptor.wait_closed()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        await self._websockets.close()
        for listener in self._websocket_listeners:
            listener.close()
        for link in self._links.values():
            link.close()
        self._compiler.shutdown(wait=False, cancel_futures=True)

    @property
    def client_count(self) -> int:
        """Connected clients."""
        return len(self._peers)

    def network_added(self, network: Network) -> None:
        """Show the nodes of a network."""
        number = next(self._network_numbers)
        kind = NodeType.SIMULATED_THYMIO if network.is_simulated else NodeType.THYMIO
        self._manager.add_network(number, kind=kind, name=network.name)
        self._links[number] = network.connect(partial(self._receive, number))
        self._deliver()

    def network_removed(self, network: Network) -> None:
        """End the nodes of a network."""
        for number, link in list(self._links.items()):
            if link.network is network:
                del self._links[number]
                link.close()
                self._manager.remove_network(number, "it was removed")
        self._deliver()

    def _receive(self, network: int, messages: Sequence[AsebaMessage]) -> None:
        """Process messages of the nodes of a network."""
        for message in messages:
            self._manager.receive_from_network(network, message)
        self._deliver()

    def _now_ns(self) -> int:
        """Time since 1970 that does not go back when the clock is set."""
        return self._clock_ns + time.monotonic_ns()

    def _run(self, work: Coroutine[None, None, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._tasks.add(task)
        task.add_done_callback(self._tasks.discard)

    async def handle_on_page(self, request: web.BaseRequest, visitor: Visitor) -> web.StreamResponse:
        """Serve a client on the port of a page. It gives the password, if there is one, also on this computer."""
        if not self._is_open:
            raise RefusedError(HTTPStatus.SERVICE_UNAVAILABLE, "the Thymio Device Manager does not run")
        return await self._handle(request, visitor, is_direct=False)

    async def _handle(
        self, request: web.BaseRequest, visitor: Visitor, *, is_direct: bool = True
    ) -> web.StreamResponse:
        """Serve a client that asks for a WebSocket, until it disconnects. Raises RefusedError for a foreign page."""
        self._pages.check_page(visitor)
        peer = await accept_websocket(request, visitor, self._max_unsent, is_direct=is_direct)
        if peer is not None:
            await self._serve(peer)
        return web.Response() if peer is None else peer.response

    async def _advance(self) -> None:
        while True:
            try:
                self._manager.advance(self._now_ns())
                self._deliver()
                self._check_backlogs()
            except Exception:
                self._report_bug()
            await asyncio.sleep(_PERIOD_S if self._peers else _IDLE_PERIOD_S)

    async def _serve_tcp(self, accepted: socket, _address: str) -> None:
        reader, writer = await asyncio.open_connection(sock=accepted)
        try:
            await self._serve(TcpPeer(reader, writer))
        finally:
            writer.transport.abort()
            with contextlib.suppress(OSError):
                await writer.wait_closed()  # otherwise asyncio logs the error of a lost connection

    async def _serve(self, peer: Peer) -> None:
        """Process messages of a client until it disconnects."""
        if not self._slots.make_room():
            self._report("tdm clients", f"{len(self._peers)} clients of the device manager: more are rejected")
            peer.abort()
            return
        client = next(self._client_numbers)
        slot = self._slots.add(peer.visitor.address)
        slot.close = partial(self._disconnect, client, "another client needs its place, and it has sent no handshake")
        self._peers[client] = peer
        self._manager.join(client, is_local=_is_local(peer))
        try:
            await self._read(client, peer, slot)
        except TooManyAttemptsError as error:
            self._report(
                "tdm password", f"client {peer.visitor.address} of the device manager is disconnected: {error}"
            )
            peer.abort()
        except TdmFrameError as error:
            self._report("tdm frame", f"client {peer.visitor.address} of the device manager is disconnected: {error}")
            peer.abort()
        except Exception:
            self._report_bug()
            peer.abort()
        finally:
            self._peers.pop(client, None)
            self._slots.remove(slot)
            self._congested.discard(client)
            self._manager.leave(client)
            self._deliver()

    async def _read(self, client: int, peer: Peer, slot: ConnectionSlot) -> None:
        spent = self._throttle.client()
        async for buffer in peer.buffers():
            if client not in self._peers:
                return
            with spent.measured():
                message = decode(buffer)
            await self._count_password(message, peer)
            with spent.measured():
                compilation = self._manager.receive(client, message)
                if self._manager.is_greeted(client):
                    self._slots.set_phase(slot, Phase.STREAMING)
                asked = self._deliver()
            if compilation is not None:
                result = await asyncio.get_running_loop().run_in_executor(self._compiler, compilation.run)
                self._manager.finish_compilation(compilation, result)
                asked |= self._deliver()
            while any(self._links[network].is_full for network in asked if network in self._links):
                await asyncio.sleep(_FULL_PAUSE_S)
            await spent.pause_if_busy()

    async def _count_password(self, message: TdmMessage, peer: Peer) -> None:
        """Delay the message that has a client's password, or raise TooManyAttemptsError, as long as many were wrong."""
        if isinstance(message, ConnectionHandshake) and not _is_local(peer):
            await self._passwords.role_of(message.password, peer.visitor)

    def _deliver(self) -> set[int]:
        """Send what the manager has for networks and clients; return the networks that have got something."""
        asked: set[int] = set()
        if self._is_delivering:  # a network answers at once; the call that is active sends the rest
            return asked
        self._is_delivering = True
        try:
            for network, program in self._manager.pop_programs():
                if network in self._links:
                    self._links[network].remember(program)
            while messages := self._manager.pop_messages():
                for network, message in messages:
                    if network in self._links:
                        asked.add(network)
                        self._links[network].send(message)
            for delivery in self._manager.pop_deliveries():
                if isinstance(delivery, Closing):
                    self._disconnect(delivery.client, delivery.reason)
                    continue
                buffer = encode(delivery.message)
                for client in delivery.clients:
                    if client in self._peers:
                        self._peers[client].send(buffer)
        finally:
            self._is_delivering = False
        return asked

    def _report_error(self, error: OSError) -> None:
        self._report("tdm accept", f"Thymio Device Manager: {error.strerror}")

    def _report_bug(self) -> None:
        """Report the exception that is handled."""
        text = traceback.format_exc()
        self._report("tdm bug", f"Thymio Device Manager: internal error (please report):\n{text}")

    def _check_backlogs(self) -> None:
        """Slow clients are sent less, and disconnected if even that is not read."""
        for client, peer in list(self._peers.items()):
            backlog, is_slow = peer.backlog, client in self._congested
            if backlog > self._max_unsent:
                self._disconnect(client, "it does not read what it is sent")
            elif not is_slow and backlog > _CONGESTED:
                self._congested.add(client)
                self._manager.set_congested(client, is_congested=True)
            elif is_slow and backlog < _DRAINED:
                self._congested.discard(client)
                self._manager.set_congested(client, is_congested=False)
        self._deliver()

    def _disconnect(self, client: int, reason: str) -> None:
        """Disconnect a client; what it has sent and is not processed yet is dropped."""
        peer = self._peers.pop(client, None)
        if peer is not None:
            self._report(
                "tdm closing", f"client {peer.visitor.address} of the device manager is disconnected: {reason}"
            )
            peer.abort()


def _is_local(peer: Peer) -> bool:
    """Whether a client is on this computer."""
    return peer.is_direct and is_this_computer(peer.visitor.address)
