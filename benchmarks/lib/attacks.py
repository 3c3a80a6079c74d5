"""Clients that flood the servers of a suite, as a process: `python -m benchmarks.lib.attacks NAME PORT`."""

from __future__ import annotations

import asyncio
import contextlib
import json
import sys
from collections.abc import Awaitable, Callable, Mapping

from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import WebSocketException

from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS

__all__ = ["ATTACKS"]

_ALL_PARAMETERS = json.dumps({"op": "getParameters", "parameterNames": [], "id": "all"})
_MANY_PARAMETERS = json.dumps(
    {
        "op": "setParameters",
        "parameters": [{"name": f"/simulator.none_{number}", "value": number} for number in range(2000)],
        "id": "set",
    }
)
_LISTS = f'{{"op":"getParameters","parameterNames":[{"[]," * 1_000_000}""],"id":"lists"}}'
_TEXT = json.dumps({"op": "getParameters", "parameterNames": ["\\u00e9" * 600_000], "id": "text"})


def _connected(port: int) -> connect:
    return connect(f"ws://127.0.0.1:{port}/", subprotocols=SUBPROTOCOLS, compression=None, max_size=None, proxy=None)


async def _discard(client: ClientConnection) -> None:
    with contextlib.suppress(WebSocketException):
        async for _ in client:
            pass


def _sending(message: str, clients: int) -> Callable[[int], Awaitable[None]]:
    """Clients that send a message without a pause, and read."""

    async def one(port: int) -> None:
        async with _connected(port) as client:
            reading = asyncio.create_task(_discard(client))
            while not reading.done():
                await client.send(message)
                await asyncio.sleep(0)

    return lambda port: _repeated(one, port, clients)


async def _ping(port: int) -> None:
    async with _connected(port) as client:
        reading = asyncio.create_task(_discard(client))
        while not reading.done():
            await client.ping()
            await client.send("")
            await asyncio.sleep(0)


async def _never_read(port: int) -> None:
    """Subscribe to everything, ask for everything, and do not read."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port, limit=1024)
    head = "Host: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
    key = f"Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: {SUBPROTOCOLS[0]}\r\n\r\n"
    writer.write(f"GET / HTTP/1.1\r\n{head}{key}".encode())
    await reader.readline()
    data = _ALL_PARAMETERS.encode()
    while True:
        writer.write(bytes([0x81, 0x80 | len(data)]) + bytes(4) + data)
        await writer.drain()
        await asyncio.sleep(0.001)


async def _come_and_go(port: int) -> None:
    async with _connected(port) as client:
        await client.send(_ALL_PARAMETERS)


async def _stay_silent(port: int) -> None:
    await asyncio.open_connection("127.0.0.1", port)
    await asyncio.sleep(3600)


async def _ask_by_halves(port: int) -> None:
    _, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(b"GET / HTTP/1.1\r\nHost: local")
    await asyncio.sleep(3600)


async def _repeated(one: Callable[[int], Awaitable[None]], port: int, clients: int) -> None:
    """So many clients, each again when it has ended."""

    async def forever() -> None:
        while True:
            with contextlib.suppress(OSError, WebSocketException):
                await one(port)
            await asyncio.sleep(0.01)

    await asyncio.gather(*(forever() for _ in range(clients)))


ATTACKS: Mapping[str, Callable[[int], Awaitable[None]]] = {
    "getParameters of everything, 8 clients": _sending(_ALL_PARAMETERS, 8),
    "setParameters, 2000 at once, 4 clients": _sending(_MANY_PARAMETERS, 4),
    "3 MB of lists in JSON, 4 clients": _sending(_LISTS, 4),
    "4 MB of escapes in JSON, 4 clients": _sending(_TEXT, 4),
    "pings and empty frames, 8 clients": lambda port: _repeated(_ping, port, 8),
    "getParameters, and no reading, 8 clients": lambda port: _repeated(_never_read, port, 8),
    "connect, ask and leave, 8 clients": lambda port: _repeated(_come_and_go, port, 8),
    "600 silent connections": lambda port: _repeated(_stay_silent, port, 600),
    "300 half requests": lambda port: _repeated(_ask_by_halves, port, 300),
}
"""By name, functions of a port that flood it until they are cancelled."""


if __name__ == "__main__":
    asyncio.run(ATTACKS[sys.argv[1]](int(sys.argv[2])))  # type: ignore[arg-type]
