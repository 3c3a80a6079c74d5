"""The Aseba protocol on TCP: one port for each network, or one port for all.

Any number of tools, up to a limit, can be connected to one robot at a time. Each frame is written by one call with
Nagle's algorithm off, as `thymiodirect` needs it (docs/spec/aseba-protocol.md section 1.1). What a client sends is read
in small pieces, and a client that uses much of the loop's time is paused, so that none delays another one for long.
"""

from __future__ import annotations

import asyncio
import contextlib
import errno
import socket
import time
from collections.abc import Callable, Sequence

from aseba_vm.protocol import FrameReader, Message, ProtocolError, decode, encode
from thymio_sim_ros.bridge.connections import Connections, ConnectionSlot, Phase
from thymio_sim_ros.bridge.listening import listen
from thymio_sim_ros.bridge.throttle import Throttle
from thymio_sim_ros.network.acceptor import Acceptor
from thymio_sim_ros.network.hub import Connection, Hub, Network
from thymio_sim_ros.network.settings import LAST_PORT, OFF, NetworkSettings

__all__ = ["MAX_CLIENTS", "MAX_UNSENT", "AsebaServer"]

MAX_CLIENTS = 32
"""Clients of one port. At this number, a new one gets the slot of one that has not sent a message yet."""
MAX_PAYLOAD = 4096
"""Longest accepted payload in bytes; tools send 516 at most. Other protocols are recognized by longer ones."""
MAX_UNSENT = 1 << 20
"""Bytes that wait for a client that does not read; it is disconnected beyond them."""
_READ_BYTES = 512
"""Bytes of a client that are handled without a break: about fifty messages, half a millisecond."""
_SLICE_S = 0.002
"""Processor time after which a busy client is paused for as long."""
_RETRY_S = 0.005
"""Time after which a client that had to pause, because its messages wait for the robots, is read again."""

Report = Callable[[str, str], None]
"""Takes a warning: what it is about, so that repetitions can be limited, and the text."""


class AsebaServer:
    """Serves the networks of a hub. Only for the thread of the event loop."""

    def __init__(self, hub: Hub, settings: NetworkSettings, report: Report) -> None:
        """Serve nothing until `start`."""
        self._hub, self._settings, self._report = hub, settings, report
        self._throttle = Throttle(_SLICE_S)
        self._ports: dict[int, _Port] = {}
        """Ports by place; that of all networks is 0."""
        self.ports_changed: Callable[[], None] = lambda: None
        """Called when `ports` has changed."""

    @property
    def ports(self) -> dict[int, list[Network]]:
        """The networks of each open port."""
        return {port.number: list(port.networks) for port in self._ports.values() if port.number != OFF}

    def start(self) -> None:
        """Serve the networks that are there, and those that come."""
        self._hub.follow(self)

    async def close(self) -> None:
        """Close all ports and connections."""
        self._hub.unfollow(self)
        for port in self._ports.values():
            port.close()
        self._ports.clear()

    def network_added(self, network: Network) -> None:
        """Open the port of a network, or add it to the port of all. A port that cannot be opened is reported."""
        place = 0 if self._settings.is_aseba_shared else network.place
        if place not in self._ports:
            first = self._settings.aseba_port
            port = _Port(self._report, self._throttle)
            self._ports[place] = port
            try:
                port.open(self._settings.aseba_address, first + place if first else 0)
            except OSError as error:
                self._report(f"aseba {place}", f"Aseba port of {network.name or 'the robot'}: {error.strerror}")
        self._ports[place].add(network)
        self.ports_changed()

    def network_removed(self, network: Network) -> None:
        """Disconnect the clients of a network, and close its port unless others use it."""
        for place, port in list(self._ports.items()):
            if network in port.networks:
                port.remove(network)
                if not port.networks:
                    port.close()
                    del self._ports[place]
        self.ports_changed()


class _Port:
    """One TCP port, the networks behind it and its clients."""

    def __init__(self, report: Report, throttle: Throttle) -> None:
        self.report, self.throttle = report, throttle
        self.number = OFF
        self.networks: list[Network] = []
        self.clients: set[_Client] = set()
        self.slots = Connections(MAX_CLIENTS, time.monotonic)
        self._acceptor: Acceptor | None = None

    def open(self, address: str, number: int) -> None:
        """Listen. Raises OSError if the port cannot be used."""
        if number > LAST_PORT:
            raise OSError(errno.EINVAL, f"found {number}, expected at most {LAST_PORT}")
        listeners = listen(address, number)
        self.number = int(listeners[0].getsockname()[1])
        self._acceptor = Acceptor(
            listeners, self._serve, lambda error: self.report("accept", f"Aseba port {self.number}: {error.strerror}")
        )

    def add(self, network: Network) -> None:
        """Add a network; clients that are connected become its clients too."""
        self.networks.append(network)
        for client in self.clients:
            client.join(network)

    def remove(self, network: Network) -> None:
        """Remove a network. Clients stay for the others, if there are any."""
        self.networks.remove(network)
        for client in list(self.clients):
            client.leave(network)

    def close(self) -> None:
        """Stop listening and disconnect all clients."""
        if self._acceptor is not None:
            self._acceptor.close()

    async def _serve(self, accepted: socket.socket, address: str) -> None:
        if not self.slots.make_room():
            self.report("full", f"Aseba port {self.number}: found a client, expected at most {MAX_CLIENTS}")
            return
        slot, task = self.slots.add(address), asyncio.current_task()
        assert task is not None
        slot.close = task.cancel
        try:
            await self._serve_client(accepted, slot)
        finally:
            self.slots.remove(slot)

    async def _serve_client(self, accepted: socket.socket, slot: ConnectionSlot) -> None:
        try:
            accepted.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
            reader, writer = await asyncio.open_connection(sock=accepted, limit=_READ_BYTES)
        except OSError:  # the client has disconnected
            return
        client = _Client(self, slot, writer)
        self.clients.add(client)
        try:
            for network in self.networks:
                client.join(network)
            await client.read(reader)
        finally:
            self.clients.discard(client)
            client.leave_all()
            writer.transport.abort()
            with contextlib.suppress(OSError):
                await writer.wait_closed()  # otherwise asyncio logs the error of a lost connection
        await client.spent.pause_at_end()


class _Client:
    """One connection."""

    def __init__(self, port: _Port, slot: ConnectionSlot, writer: asyncio.StreamWriter) -> None:
        self._port, self._slot, self._transport = port, slot, writer.transport
        self._frames = FrameReader(MAX_PAYLOAD)
        self._connections: dict[Network, Connection] = {}
        self.spent = port.throttle.client()
        """Time that was spent on it."""

    def join(self, network: Network) -> None:
        """Become a client of a network."""
        with self.spent.measured():
            self._connections[network] = network.connect(self._send)

    def leave(self, network: Network) -> None:
        """Leave a network, and disconnect with the last one."""
        connection = self._connections.pop(network, None)
        if connection is not None:
            connection.close()
        if not self._connections:
            self._transport.close()

    def leave_all(self) -> None:
        """Leave all networks."""
        for network in list(self._connections):
            self.leave(network)

    def abort(self) -> None:
        """Disconnect at once."""
        self._transport.abort()

    async def read(self, reader: asyncio.StreamReader) -> None:
        """Pass messages of the client to the nodes until it disconnects."""
        try:
            while data := await reader.read(_READ_BYTES):
                with self.spent.measured():
                    self._receive(data)
                await asyncio.sleep(0)  # more bytes may be there already: the others come first
                while any(connection.is_full for connection in self._connections.values()):
                    await asyncio.sleep(_RETRY_S)
                await self.spent.pause_if_busy()
        except ProtocolError as error:
            self._warn(f"{error}; disconnected, as this is no Aseba message")
        except OSError:
            pass  # a lost connection is handled like a closed one

    def _receive(self, data: bytes) -> None:
        messages = []
        for frame in self._frames.feed(data):
            try:
                messages.append(decode(frame))
            except ProtocolError as error:  # the frame is complete, so the next ones can be read
                self._warn(str(error))
        if messages:
            self._port.slots.set_phase(self._slot, Phase.STREAMING)
        for connection in list(self._connections.values()):
            connection.send(*messages)

    def _send(self, messages: Sequence[Message]) -> None:
        with self.spent.measured():
            for message in messages:
                if self._transport.is_closing():
                    return
                if self._transport.get_write_buffer_size() > MAX_UNSENT:
                    self._warn(f"does not read {MAX_UNSENT} bytes that it was sent; disconnected")
                    self.abort()
                    return
                try:
                    self._transport.write(encode(message))
                except ProtocolError as error:
                    self._warn(f"internal error (please report): {error}")

    def _warn(self, text: str) -> None:
        address = self._slot.address
        self._port.report(f"client {address}", f"Aseba port {self._port.number}, client {address}: {text}")
