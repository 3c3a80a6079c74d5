"""The time of the event loop that one client can use is limited, and other clients are served in between."""

from __future__ import annotations

import asyncio
import socket
import time
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager, suppress

import pytest
from websockets.exceptions import ConnectionClosedError

from tests.bridge.peers import Client, LoopIterations, StalledClient, bridge, masked_frame, run
from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import ServerSettings
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.bounded_json import MAX_STRUCTURE
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.pending_requests import MAX_PENDING_CALLS

pytestmark = pytest.mark.process

PING = bytes([0x89, 0x80, 0, 0, 0, 0])
CLIENT_FRAME = ms.ServiceRequest(7, 1, "cdr", b"")
"""A call of a service that does not exist: it is rejected immediately."""


@asynccontextmanager
async def flooder(port: int) -> AsyncIterator[StalledClient]:
    """A client that sends given bytes and reads no answers."""
    client = StalledClient(port)
    await client.connect()
    try:
        yield client
    finally:
        client.abort()


class SlowClock:
    """Every message costs a millisecond of processor time, and comes a second after the one before."""

    def __init__(self) -> None:
        self._spent_s, self._now_s = 0.0, time.monotonic()

    def thread_time(self) -> float:
        self._spent_s += 0.001
        return self._spent_s

    def monotonic(self) -> float:
        self._now_s += 1.0
        return self._now_s


def test_a_client_with_few_messages_does_not_wait_for_throttled_clients(monkeypatch: pytest.MonkeyPatch) -> None:
    """Clients that connected and disconnected once delayed another one by more than a second."""

    async def scenario() -> None:
        async with bridge() as server, server.client() as client:
            await client.settle()
            monkeypatch.setattr("thymio_sim_ros.bridge.throttle.time", SlowClock())
            async with server.server.throttle._turns.take(0.0):
                for _ in range(20):
                    await client.settle()

    run(scenario())


@pytest.mark.parametrize(
    ("frame", "count"), [(PING, 40_000), (masked_frame(CLIENT_FRAME), 3000)], ids=["pings", "calls"]
)
def test_many_frames_in_one_packet_are_handled_in_many_iterations(frame: bytes, count: int) -> None:
    async def scenario() -> int:
        async with bridge() as server, server.client() as other, flooder(server.port) as client:
            await other.settle()
            flood = frame * count
            handled: list[int] = []
            turns = LoopIterations()

            async def send() -> None:
                await asyncio.get_running_loop().sock_sendall(client._socket, flood)
                await client.say(ms.FetchAsset("end", 1))

            async def watch() -> None:
                await server.sink.until(lambda events: ev.AssetRequested(2, "end", 1) in events)
                handled.append(turns.count)

            async def read() -> None:
                while not handled:  # the answers, so that it is not cut off
                    await client._next()

            reading = asyncio.create_task(read())
            await asyncio.gather(send(), watch())
            reading.cancel()
            turns.stop()
            return handled[0]

    assert run(scenario()) > 20


def test_rejected_calls_do_not_delay_other_clients() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as busy, server.client() as other:
            side = ms.ServiceSide("cdr", "t", "ros2msg", "")
            server.server.execute(ev.AddServices((ms.Service(5, "/s", "t", side, side),)))
            for number in range(3000):
                await busy.send(ms.ServiceRequest(5, number, "cdr", b""))
            await other.send(ms.ServiceRequest(5, 1, "cdr", b""))
            await server.sink.until(lambda events: any(getattr(event, "client", 0) == 2 for event in events))
            await busy.settle()
            calls = [event for event in server.sink.events if isinstance(event, ev.ServiceCalled)]
            assert len([call for call in calls if call.client == 1]) == MAX_PENDING_CALLS

    run(scenario())


@pytest.mark.parametrize(
    "frame",
    [
        '{"op":"setParameters","parameters":[' + "[],{}," * 600_000 + "1]}",
        '{"op":"unsubscribe","subscriptionIds":[' + "1," * 2_000_000 + "1]}",
        '{"op":' + "[" * 4_000_000,
        "é\x01" * 1_300_000,
    ],
    ids=["lists", "numbers", "brackets", "no JSON"],
)
def test_a_long_frame_with_much_structure_is_rejected_before_it_is_decoded(frame: str) -> None:
    async def scenario() -> str:
        async with bridge() as server, server.client() as client:
            await client.connection.send(frame)
            return (await client.next(ms.Status)).message

    assert run(scenario()) == (
        f"text frame: expected at most {MAX_STRUCTURE} characters outside of strings, found more"
    )


def test_a_playground_with_images_is_accepted() -> None:
    """The largest message of the page: a file of 3 MB in base64."""
    wish = ms.Parameter("/simulator.playground", "data:application/octet-stream;base64," + "A" * 4_000_000)

    async def scenario() -> None:
        async with bridge() as server, server.client() as client:
            await client.send(ms.SetParameters((wish,), "q"))
            await server.sink.until(bool)
            assert server.sink.events == [ev.ParametersSet(1, (wish,), "q")]

    run(scenario())


def test_more_clients_than_the_limit_are_rejected_until_one_disconnects() -> None:
    async def scenario() -> None:
        async with bridge(ServerSettings(max_clients=2)) as server:
            async with server.client() as first, server.client() as second:
                await first.settle()
                await second.settle()
                async with server.client() as third:
                    with pytest.raises(ConnectionClosedError, match="too many clients"):
                        await third.settle()
            await server.until(lambda: server.server.client_count == 0)
            async with server.client() as client:
                await client.settle()

    run(scenario())


@pytest.mark.parametrize("begin", [b"", b"GET / HTTP/1.1\r\nHost: localhost\r\n"])
def test_connections_without_a_handshake_make_room_for_clients(begin: bytes) -> None:
    async def scenario() -> None:
        async with bridge(max_connections=4) as server, server.client() as first:
            silent = []
            for _ in range(6):
                silent.append(socket.create_connection(("127.0.0.1", server.port)))
                silent[-1].sendall(begin)
            await server.until(lambda: server.slots.is_full)
            async with server.client() as second:
                await first.settle()
                await second.settle()
            for one in silent:
                one.close()

    run(scenario())


def test_silent_connections_are_limited_and_free_their_slots_when_they_close() -> None:
    async def scenario() -> None:
        async with bridge(max_connections=4) as server:
            loop = asyncio.get_running_loop()
            silent = [socket.create_connection(("127.0.0.1", server.port)) for _ in range(5)]
            for one in silent:
                one.setblocking(False)
            async with asyncio.timeout(PATIENCE_S):
                with suppress(ConnectionError):
                    assert await loop.sock_recv(silent[0], 1) == b""
            for one in silent:
                one.close()
            await server.until(lambda: not server.slots)
            async with server.client() as client:
                await client.settle()

    run(scenario())


async def greeting(client: Client) -> ms.Advertise:
    """The channels that a new client receives."""
    return await client.next(ms.Advertise)


def test_new_clients_receive_the_current_channels() -> None:
    """The encoded first messages are cached for later clients."""

    async def scenario() -> None:
        async with bridge() as server:
            for number in range(20, 23):
                channel = ms.Channel(number, f"/t{number}", "cdr", "t", "")
                server.server.execute(ev.AddChannels((channel,)))
                for _ in range(2):
                    async with server.client() as client:
                        assert channel in (await greeting(client)).channels
            server.server.execute(ev.RemoveChannels((21,)))
            async with server.client() as client:
                assert [channel.id for channel in (await greeting(client)).channels] == [10, 20, 22]

    run(scenario())


def test_values_for_a_client_that_asks_for_much_delay_neither_messages_nor_values_for_others(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Values of all parameters, each some milliseconds of work, occupied the loop for up to fifteen seconds."""
    monkeypatch.setattr("thymio_sim_ros.bridge.server._SLICE_S", 0.0)

    async def scenario() -> None:
        async with bridge() as server, server.client() as busy, server.client() as other:
            await other.subscribe(1)
            await busy.settle()
            for number in range(500):
                server.server.execute(ev.SendParameters(1, None, f"busy{number}"))
            server.server.execute(ev.SendParameters(2, None, "other"))
            server.publish(b"data")
            assert (await other.next(ms.MessageData)).payload == b"data"
            assert (await other.next(ms.ParameterValues)).id == "other"
            assert server.server._values
            assert [(await busy.next(ms.ParameterValues)).id for _ in range(500)] == [f"busy{n}" for n in range(500)]

    run(scenario())
