"""Malicious clients, and clients that connect and disconnect: others are not affected, and nothing is left."""

from __future__ import annotations

import asyncio
import gc
import random
import socket
from collections import Counter
from collections.abc import Iterator

import pytest
from aiohttp.web import WebSocketResponse

from tests.bridge.peers import CHANNEL, Bridge, Client, StalledClient, bridge, run
from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import ServerSettings
from thymio_sim_ros.bridge.client_send_queue import ClientSendQueue
from thymio_sim_ros.bridge.client_socket import ClientSocket
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.web.http_connections import _Connection

pytestmark = pytest.mark.process

FRAMES = 10_000
VISITS = 500
SAID = (
    ms.Subscribe((ms.Subscription(1, CHANNEL.id),)),
    ms.Unsubscribe((1,)),
    ms.ClientAdvertise((ms.ClientChannel(1, "/a", "cdr", "std_msgs/Bool"),)),
    ms.ClientUnadvertise((1,)),
    ms.ClientMessageData(1, b"data"),
    ms.ServiceRequest(1, 2, "cdr", b"data"),
    ms.GetParameters(("/n.p",), "q"),
    ms.SetParameters((ms.Parameter("/n.p", 1.0),), "q"),
    ms.SubscribeParameterUpdates(("/n.p",)),
    ms.SubscribeConnectionGraph(),
    ms.FetchAsset("package://p/m.stl", 1),
)


def mutated(rng: random.Random) -> Iterator[str | bytes]:
    """Frames with bytes changed, cut out, doubled, or taken from another frame."""
    frames = [wire.encode_client(message) for message in SAID]
    for _ in range(FRAMES):
        frame = rng.choice(frames)
        data = bytearray(frame.encode() if isinstance(frame, str) else frame)
        for _ in range(rng.randint(1, 3)):
            start = rng.randrange(len(data) + 1)
            end = min(len(data), start + rng.choice((0, 1, 1, 4)))
            piece = rng.choice((b"", rng.randbytes(1), b"\xff\xff\xff\xff", b"9" * 30, b"[[", b"null", bytes(data)))
            data[start:end] = piece
        yield data.decode(errors="replace") if isinstance(frame, str) else bytes(data)


@pytest.mark.parametrize("seed", [5, pytest.param(6, marks=pytest.mark.slow)])
def test_mutated_frames_do_not_affect_the_server_and_other_clients(seed: int) -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as fuzzer, server.client() as other:
            await other.subscribe(1)
            answers = asyncio.create_task(count_until(fuzzer, "'the end'"))
            for number, frame in enumerate(mutated(random.Random(seed))):
                await fuzzer.connection.send(frame)
                if number % 100 == 0:
                    server.publish(number.to_bytes(4, "little"))
                    assert (await other.next(ms.MessageData)).payload == number.to_bytes(4, "little")
            await fuzzer.connection.send("the end")
            assert await answers > FRAMES // 10

    run(scenario())


async def count_until(client: Client, text: str) -> int:
    """Messages until a status that contains the text."""
    count = 0
    while True:
        message = await client.next(object)
        count += 1
        if isinstance(message, ms.Status) and text in message.message:
            return count


def test_clients_that_come_and_go_leave_nothing_behind() -> None:
    async def scenario() -> None:
        async with bridge() as server:
            tasks = len(asyncio.all_tasks())
            await visit(server, 1)
            await server.until(lambda: server.server.client_count == 0 and len(asyncio.all_tasks()) == tasks)
            before, things = census(), len(gc.get_objects())
            for number in range(VISITS):
                await visit(server, number)
            await server.until(lambda: server.server.client_count == 0 and len(asyncio.all_tasks()) == tasks)
            assert census() == before
            server.sink.events.clear()
            assert len(gc.get_objects()) < things + VISITS

    run(scenario())


async def visit(server: Bridge, number: int) -> None:
    """Connect, use each kind of message, and disconnect; every third client without a closing handshake."""
    if number % 3 == 2:
        guest = StalledClient(server.port)
        await guest.connect()
        await guest.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
        guest.abort()
        return
    async with server.client() as client:
        await client.subscribe(number)
        await client.send(ms.ClientAdvertise((ms.ClientChannel(number, "/a", "cdr", "std_msgs/Bool"),)))
        await client.send(ms.SubscribeConnectionGraph(), ms.SubscribeParameterUpdates((f"/n.p{number}",)))


def census() -> Counter[type]:
    """Number of existing objects of each type that belongs to a connection."""
    gc.collect()
    kinds = (ClientState, ClientSendQueue, ClientSocket, WebSocketResponse, _Connection, asyncio.Task, socket.socket)
    return Counter(type(thing) for thing in gc.get_objects() if type(thing) in kinds)


def test_a_stalled_client_costs_its_limit_and_one_message() -> None:
    limit, message = 1 << 16, bytes(1 << 12)

    async def scenario() -> None:
        async with bridge(ServerSettings(buffer_limit=limit)) as server:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await stalled.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await server.sink.until(lambda events: len(events) == 1)
            (queue,) = server.server._queues.values()
            for _ in range(5000):  # 20 MB
                server.publish(message)
                await asyncio.sleep(0)
                assert queue.size <= limit + 2 * len(message)
            assert queue.size > limit
            stalled.abort()

    run(scenario())


def test_one_large_answer_reaches_a_client_that_reads() -> None:
    size = 20 << 20

    async def scenario() -> None:
        async with bridge(ServerSettings(buffer_limit=1 << 14)) as server, server.client() as client:
            server.server.execute(ev.ParametersChanged((ms.Parameter("/n.p", "x" * size),)))
            await client.send(ms.GetParameters((), "large"))
            answer = await client.next(ms.ParameterValues)
            assert [len(str(item.value)) for item in answer.parameters] == [size]

    run(scenario())


def test_a_flood_of_control_answers_to_a_stalled_client_is_bounded() -> None:
    async def scenario() -> None:
        limit = 1 << 14
        async with bridge(ServerSettings(buffer_limit=limit)) as server, server.client() as other:
            await other.subscribe(1)
            server.server.execute(ev.ParametersChanged((ms.Parameter("/n.p", "x" * limit),)))
            stalled = StalledClient(server.port)
            await stalled.connect()
            async with asyncio.timeout(PATIENCE_S):
                while server.server.client_count == 2:
                    try:
                        await stalled.say(ms.GetParameters((), "more"))
                    except ConnectionError:
                        break
                    await asyncio.sleep(0)
            server.publish(b"still here")
            assert (await other.next(ms.MessageData)).payload == b"still here"
            stalled.abort()

    run(scenario())
