"""A real server and several real clients on loopback."""

from __future__ import annotations

import asyncio
import ssl
from pathlib import Path

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Subprotocol

from tests.bridge.certificates import make_certificate
from tests.bridge.peers import CHANNEL, Client, StalledClient, bridge, run
from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import SUBPROTOCOLS, Capability, ServerSettings, Tokens
from thymio_sim_ros.bridge.handshake import WRONG_TOKEN
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.wire import encode_client
from thymio_sim_ros.bridge.settings import REFUSED_FACTOR
from thymio_sim_ros.bridge.switchboard import events as ev

pytestmark = pytest.mark.process

LIMIT = 1 << 16
KILOBYTE = bytes(1024)


@pytest.mark.parametrize(
    ("offered", "accepted"),
    [
        (("foxglove.websocket.v1", "foxglove.sdk.v1"), "foxglove.sdk.v1"),
        (("foxglove.websocket.v1",), "foxglove.websocket.v1"),
        (("other", "foxglove.sdk.v1"), "foxglove.sdk.v1"),
    ],
)
def test_both_names_of_the_protocol_are_spoken(offered: tuple[str, ...], accepted: str) -> None:
    async def scenario() -> str | None:
        async with bridge() as server, server.client(subprotocols=[*map(Subprotocol, offered)]) as client:
            return client.connection.subprotocol

    assert run(scenario()) == accepted


@pytest.mark.parametrize("version", [ssl.TLSVersion.TLSv1_2, ssl.TLSVersion.TLSv1_3])
def test_a_client_connects_with_either_version_of_tls(tmp_path: Path, version: ssl.TLSVersion) -> None:
    cert, key = make_certificate(tmp_path)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(cert, key)
    trust = ssl.create_default_context(cafile=cert)
    trust.minimum_version = trust.maximum_version = version

    async def scenario() -> ms.ServerInfo:
        async with bridge(tls=tls) as server:
            address = f"wss://localhost:{server.port}"
            async with connect(address, subprotocols=SUBPROTOCOLS, ssl=trust) as connection:
                return await Client(connection).next(ms.ServerInfo)

    assert run(scenario()).name == "test"


def test_a_client_of_another_protocol_is_rejected() -> None:
    async def scenario() -> None:
        async with bridge() as server, connect(server.url, subprotocols=[Subprotocol("chat")]):
            pass

    with pytest.raises(InvalidStatus, match="400"):
        run(scenario())


def test_a_page_from_elsewhere_is_rejected_with_the_reason() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client(origin="https://evil.example"):
            pass

    with pytest.raises(InvalidStatus) as caught:
        run(scenario())
    assert caught.value.response.status_code == 403
    assert b"allowed_origins" in caught.value.response.body


def test_a_page_of_this_machine_is_accepted() -> None:
    async def scenario() -> ms.ServerInfo:
        async with bridge() as server, server.client(origin="http://localhost:8080") as client:
            return await client.next(ms.ServerInfo)

    assert run(scenario()).name == "test"


def test_without_clients_the_event_loop_is_not_woken_and_the_first_one_gets_what_was_posted() -> None:
    async def scenario() -> None:
        async with bridge() as server:
            before = len(server.server._pending)
            for number in range(20, 30):
                server.server.execute(ev.AddChannels((ms.Channel(number, f"/t{number}", "cdr", "t", ""),)))
                await asyncio.sleep(0)
            assert len(server.server._pending) == before + 10
            async with server.client() as client:
                assert [each.id for each in (await client.next(ms.Advertise)).channels] == [10, *range(20, 30)]
                assert not server.server._pending

    run(scenario())


def test_messages_reach_every_subscriber_under_its_own_id() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as one, server.client() as two:
            await one.subscribe(1)
            await two.subscribe(2)
            server.publish(b"a", b"b")
            for client, subscription in ((one, 1), (two, 2)):
                assert await client.next(ms.MessageData) == ms.MessageData(subscription, 0, b"a")
                assert await client.next(ms.MessageData) == ms.MessageData(subscription, 1, b"b")

    run(scenario())


def test_new_and_removed_channels_are_sent_to_all_clients() -> None:
    async def scenario() -> None:
        added = ms.Channel(11, "/u", "cdr", "std_msgs/msg/Bool", "bool data", "ros2msg")
        async with bridge() as server, server.client() as one, server.client() as two:
            for client in (one, two):
                assert await client.next(ms.Advertise) == ms.Advertise((CHANNEL,))
            server.server.execute(ev.AddChannels((added,)))
            server.server.execute(ev.RemoveChannels((11,)))
            for client in (one, two):
                assert await client.next(ms.Advertise) == ms.Advertise((added,))
                assert await client.next(ms.Unadvertise) == ms.Unadvertise((11,))

    run(scenario())


def test_equal_client_channel_ids_of_two_clients_are_not_confused() -> None:
    async def scenario() -> list[ev.Event]:
        async with bridge() as server, server.client() as one, server.client() as two:
            for client, topic in ((one, "/a"), (two, "/b")):
                await client.send(ms.ClientAdvertise((ms.ClientChannel(1, topic, "cdr", "std_msgs/Bool"),)))
                await client.settle()
            await two.send(ms.ClientMessageData(1, b"two"))
            await two.settle()
            await one.send(ms.ClientMessageData(1, b"one"))
            await one.settle()
            return server.sink.events[:4]

    opened_a, opened_b, *sent = run(scenario())
    assert isinstance(opened_a, ev.ClientChannelOpened)
    assert isinstance(opened_b, ev.ClientChannelOpened)
    assert (opened_a.channel.topic, opened_b.channel.topic) == ("/a", "/b")
    assert sent == [
        ev.ClientMessageReceived(opened_b.client, 1, b"two"),
        ev.ClientMessageReceived(opened_a.client, 1, b"one"),
    ]


def test_a_bad_frame_is_answered_and_the_connection_kept() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as client, server.client() as other:
            for bad in ("no json", b"", b"\x09", '{"op":"dance"}', b"\x01\x01"):
                await client.connection.send(bad)
                assert (await client.next(ms.Status)).level == StatusLevel.ERROR
            for peer in (client, other):
                await peer.subscribe(1)
            server.publish(b"still here")
            for peer in (client, other):
                assert (await peer.next(ms.MessageData)).payload == b"still here"

    run(scenario())


def test_a_too_long_frame_is_answered_and_the_connection_kept() -> None:
    async def scenario() -> None:
        settings = ServerSettings(max_message_size=1000)
        async with bridge(settings) as server, server.client() as client:
            for frame in ("x" * 1001, bytes([1]) * 1001, encode_client(ms.ServiceRequest(7, 8, "cdr", bytes(1000)))):
                await client.connection.send(frame)
                if isinstance(frame, bytes) and frame[0] == 2:
                    failure = await client.next(ms.ServiceCallFailure)
                    assert (failure.service_id, failure.call_id) == (7, 8)
                    assert failure.message.startswith("frame: expected at most 1000 bytes (max_message_size), found 10")
                status = await client.next(ms.Status)
                assert status.message.startswith("frame: expected at most 1000 bytes (max_message_size), found 10")
            await client.subscribe(1)
            server.publish(b"still here")
            assert (await client.next(ms.MessageData)).payload == b"still here"

    run(scenario())


def test_an_excessive_frame_ends_that_connection_only() -> None:
    async def scenario() -> None:
        settings = ServerSettings(max_message_size=1000)
        async with bridge(settings) as server, server.client() as client, server.client() as other:
            await client.connection.send(bytes(REFUSED_FACTOR * 1000 + 1))
            with pytest.raises(ConnectionClosed, match="1009"):
                await client.next(ms.MessageData)
            await other.subscribe(1)
            server.publish(b"still here")
            assert (await other.next(ms.MessageData)).payload == b"still here"

    run(scenario())


def test_a_client_that_disconnects_is_removed() -> None:
    async def scenario() -> None:
        async with bridge() as server:
            client = StalledClient(server.port)
            await client.connect()
            await client.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await client.say(ms.ClientAdvertise((ms.ClientChannel(1, "/a", "cdr", "std_msgs/Bool"),)))
            await server.sink.until(lambda events: len(events) == 2)
            client.abort()
            await server.sink.until(lambda events: len(events) == 4)
            assert [type(event) for event in server.sink.events[2:]] == [ev.ChannelUnsubscribed, ev.ClientChannelClosed]
            assert server.server.client_count == 0

    run(scenario())


def test_messages_for_a_client_that_has_just_disconnected_are_dropped_silently(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def scenario() -> None:
        async with bridge() as server:
            client = StalledClient(server.port)
            await client.connect()
            await client.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await server.sink.until(lambda events: len(events) == 1)
            client.abort()
            server.publish(*[KILOBYTE] * 100)
            await server.until(lambda: server.server.client_count == 0)

    run(scenario())
    assert caplog.messages == []


def test_a_healthy_client_beside_a_stalled_one_loses_nothing() -> None:
    async def scenario() -> None:
        settings = ServerSettings(buffer_limit=LIMIT)
        async with bridge(settings) as server, server.client() as healthy:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await stalled.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await healthy.subscribe(1)
            await server.sink.until(lambda events: len(events) == 1)
            for number in range(5000):  # far more than the kernel's buffers and ours
                server.publish(number.to_bytes(4, "little") + KILOBYTE)
                data = await healthy.next(ms.MessageData)
                assert int.from_bytes(data.payload[:4], "little") == number
            stalled.abort()

    run(scenario())


def test_a_stalled_client_keeps_its_control_messages_and_gets_the_newest_data() -> None:
    async def scenario() -> None:
        settings = ServerSettings(buffer_limit=LIMIT)
        async with bridge(settings) as server:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await stalled.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await server.sink.until(lambda events: len(events) == 1)
            last = 20_000
            await server.flood(last + 1, lambda number: number.to_bytes(4, "little") + KILOBYTE)
            await stalled.say(ms.GetParameters((), "still answered"))
            numbers: list[int] = []
            while not numbers or numbers[-1] != last:
                numbers.append(int.from_bytes((await stalled.next(ms.MessageData)).payload[:4], "little"))
            assert numbers == sorted(numbers)
            assert len(numbers) < last
            await stalled.say(ms.GetParameters((), "answered"))
            assert (await stalled.next(ms.ParameterValues)).id in ("still answered", "answered")
            stalled.abort()

    run(scenario())


def test_a_slow_client_receives_one_warning() -> None:
    async def scenario() -> list[str]:
        async with bridge(ServerSettings(buffer_limit=LIMIT)) as server:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await stalled.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await server.sink.until(lambda events: len(events) == 1)
            await server.flood(20_000, lambda number: KILOBYTE)
            await stalled.say(ms.FetchAsset("end", 1))
            await server.sink.until(lambda events: len(events) == 2)
            server.server.execute(ev.SendToClient(1, ms.Status(StatusLevel.INFO, "end")))
            texts = []
            while "end" not in texts:
                texts.append((await stalled.next(ms.Status)).message)
            stalled.abort()
            return texts

    slow, end = run(scenario())
    assert slow.startswith("Send buffer limit reached")
    assert end == "end"


def test_a_client_with_too_many_buffered_control_messages_is_disconnected() -> None:
    async def scenario() -> None:
        async with bridge(ServerSettings(buffer_limit=LIMIT)) as server:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await server.until(lambda: server.server.client_count == 1)
            text = "x" * LIMIT
            for _ in range(200):
                server.server.execute(ev.SendToClient(1, ms.Status(StatusLevel.INFO, text)))
            await server.until(lambda: server.server.client_count == 0)
            stalled.abort()

    run(scenario())


def test_while_the_event_sink_is_full_a_busy_client_waits_and_others_are_served() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as busy, server.client() as other:
            await other.subscribe(1)
            await busy.send(ms.ClientAdvertise((ms.ClientChannel(1, "/a", "cdr", "std_msgs/Bool"),)))
            await busy.settle()
            server.sink.full = True
            await busy.send(ms.ClientMessageData(1, b"first"), ms.ClientMessageData(1, b"second"))
            server.publish(b"data")
            assert (await other.next(ms.MessageData)).payload == b"data"
            server.sink.full = False
            await server.sink.until(lambda events: len(events) == 4)
            assert [event.payload for event in server.sink.events if isinstance(event, ev.ClientMessageReceived)] == [
                b"first",
                b"second",
            ]

    run(scenario())


def test_a_client_that_waits_for_the_event_sink_does_not_delay_closing() -> None:
    async def scenario() -> None:
        async with bridge() as server, server.client() as busy:
            await busy.send(ms.ClientAdvertise((ms.ClientChannel(1, "/a", "cdr", "std_msgs/Bool"),)))
            await busy.settle()
            server.sink.full = True
            await busy.send(*[ms.ClientMessageData(1, b"data")] * 100)
            await server.sink.until(lambda events: len(events) == 2)
            async with asyncio.timeout(PATIENCE_S):
                await server.close()
            assert server.server.client_count == 0

    run(scenario())


def test_a_stalled_client_does_not_delay_closing() -> None:
    async def scenario() -> None:
        async with bridge(ServerSettings(buffer_limit=LIMIT)) as server:
            stalled = StalledClient(server.port)
            await stalled.connect()
            await stalled.say(ms.Subscribe((ms.Subscription(1, CHANNEL.id),)))
            await server.sink.until(lambda events: len(events) == 1)
            await server.flood(20_000, lambda number: KILOBYTE)
            async with asyncio.timeout(PATIENCE_S):
                await server.close()
            assert server.server.client_count == 0
            stalled.abort()

    run(scenario())


TOKENS = Tokens("fulltoken", "looktoken")
FOREIGN = "https://evil.example"


@pytest.mark.parametrize(
    ("query", "headers", "origin", "metadata"),
    [
        ("/?token=fulltoken", None, None, {}),
        ("/?token=fulltoken", None, FOREIGN, {}),
        ("", {"Authorization": "Bearer fulltoken"}, None, {}),
        ("/?token=looktoken", None, None, {"access": "read_only"}),
    ],
)
def test_a_client_with_a_token_is_accepted(
    query: str, headers: dict[str, str] | None, origin: str | None, metadata: dict[str, str]
) -> None:
    async def scenario() -> ms.ServerInfo:
        async with (
            bridge(ServerSettings(tokens=TOKENS)) as server,
            server.client(query=query, headers=headers, origin=origin) as client,
        ):
            return await client.next(ms.ServerInfo)

    info = run(scenario())
    assert info.metadata == metadata
    assert (Capability.CLIENT_PUBLISH in info.capabilities) is (not metadata)


@pytest.mark.parametrize("query", ["", "/?token=wrongtoken", "/?token="])
def test_a_program_without_a_valid_token_is_rejected_in_the_handshake(query: str) -> None:
    async def scenario() -> InvalidStatus:
        async with bridge(ServerSettings(tokens=TOKENS)) as server:
            with pytest.raises(InvalidStatus) as caught:
                async with server.client(query=query):
                    pass
            return caught.value

    response = run(scenario()).response
    assert (response.status_code, response.headers["WWW-Authenticate"]) == (401, "Bearer")
    assert b"terminal" in response.body


@pytest.mark.parametrize("query", ["", "/?token=wrongtoken"])
def test_a_page_without_a_valid_token_receives_only_the_reason(query: str) -> None:
    async def scenario() -> tuple[list[ms.Status], int]:
        async with (
            bridge(ServerSettings(tokens=TOKENS)) as server,
            server.client(query=query, origin="http://127.0.0.1:8080") as client,
        ):
            statuses = [await client.next(ms.Status)]
            with pytest.raises(ConnectionClosed) as caught:
                await client.next(object)
            assert server.server.client_count == 0
            assert caught.value.rcvd is not None
            return statuses, caught.value.rcvd.code

    statuses, code = run(scenario())
    assert code == WRONG_TOKEN
    (status,) = statuses
    assert (status.level, status.id) == (StatusLevel.ERROR, "access")


def test_wrong_tokens_are_limited_and_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    async def scenario() -> list[int]:
        async with bridge(ServerSettings(tokens=TOKENS)) as server:

            async def attempt() -> int:
                with pytest.raises(InvalidStatus) as caught:
                    async with server.client(query="/?token=guess"):
                        pass
                return caught.value.response.status_code

            statuses = await asyncio.gather(*(attempt() for _ in range(100)))
            async with server.client(query="/?token=fulltoken"):
                return statuses

    statuses = run(scenario())
    assert 30 <= statuses.count(401) < 60
    assert statuses.count(401) + statuses.count(429) == 100
    assert len(caplog.records) == 2
    assert "guess" not in caplog.text


def test_foreign_pages_are_logged_once(caplog: pytest.LogCaptureFixture) -> None:
    async def scenario() -> None:
        async with bridge() as server:
            for number in range(5):
                with pytest.raises(InvalidStatus):
                    async with server.client(origin=f"{FOREIGN}:{number}"):
                        pass

    run(scenario())
    assert len(caplog.records) == 1


def test_a_read_only_client_watches_and_does_not_disturb_the_others() -> None:
    async def scenario() -> tuple[bytes, list[ev.Event]]:
        async with (
            bridge(ServerSettings(tokens=TOKENS)) as server,
            server.client(query="/?token=looktoken") as viewer,
        ):
            await viewer.send(ms.ClientAdvertise((ms.ClientChannel(1, "/cmd_vel", "cdr", "geometry_msgs/Twist"),)))
            assert "read-only" in (await viewer.next(ms.Status)).message
            await viewer.subscribe(7)
            server.publish(b"seen")
            data = await viewer.next(ms.MessageData)
            return data.payload, server.sink.events

    payload, events = run(scenario())
    assert payload == b"seen"
    assert not any(isinstance(event, ev.ClientChannelOpened | ev.ClientMessageReceived) for event in events)
