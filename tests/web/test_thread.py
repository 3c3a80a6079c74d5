"""The thread of page and bridge: what other threads publish reaches clients of the bridge."""

from __future__ import annotations

import socket
import ssl
import subprocess
import sys
import threading
from contextlib import ExitStack
from pathlib import Path

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from tests.bridge.certificates import make_certificate, trusting
from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import SUBPROTOCOLS, BridgeServer, ServerInfo
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.web.thread import MAX_OWN, ServerThread

pytestmark = pytest.mark.process

CHANNEL = ms.Channel(1, "/t", "cdr", "std_msgs/msg/String", "string data", "ros2msg")


class Sink:
    """Sets an event when a client subscribes."""

    def __init__(self) -> None:
        self.subscribed = threading.Event()

    def is_full(self, client: int) -> bool:
        """Never."""
        return False

    def post(self, event: ev.Event) -> None:
        """Handle an event."""
        if isinstance(event, ev.ChannelSubscribed):
            self.subscribed.set()


HAS_IPV6 = socket.has_ipv6 and Path("/proc/net/if_inet6").exists()


class Served:
    """A bridge in a thread; `publish` and `execute` are those of the bridge."""

    def __init__(self, sink: Sink, port: int = 0, tls: ssl.SSLContext | None = None) -> None:
        self.thread = ServerThread(warn=print)
        try:
            self.port = self.thread.listen("localhost", port, tls)[1]
        except OSError:
            self.thread.close()
            raise
        bridge = BridgeServer(Switchboard(ServerInfo("test", ())), sink, self.thread.loop)
        self.thread.mount_bridge(bridge)
        self.bridge, self.publish, self.post, self.close = bridge, bridge.publish, bridge.execute, self.thread.close


def start(port: int = 0) -> tuple[Served, Sink]:
    sink = Sink()
    return Served(sink, port), sink


def test_the_port_is_bound_when_the_constructor_returns_and_free_after_close() -> None:
    server, _ = start()
    with pytest.raises(OSError, match=rf"cannot listen on 127\.0\.0\.1:{server.port}: address already in use"):
        start(server.port)
    server.close()
    again, _ = start(server.port)
    again.close()


@pytest.mark.skipif(not HAS_IPV6, reason="no IPv6 here")
def test_a_client_may_connect_by_ipv6() -> None:
    server, _ = start()
    with connect(f"ws://[::1]:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        assert isinstance(wire.decode_server(client.recv(timeout=PATIENCE_S)), ms.ServerInfo)
        assert server.bridge.client_count == 1
    server.close()


def test_a_process_of_this_program_gets_a_connection_without_a_port() -> None:
    server, _ = start()
    link = server.thread.connect_own()
    with connect("ws://localhost", sock=link, subprotocols=SUBPROTOCOLS, proxy=None) as client:
        assert isinstance(wire.decode_server(client.recv(timeout=PATIENCE_S)), ms.ServerInfo)
        assert server.bridge.client_count == 1
    server.close()


def test_such_connections_beyond_their_limit_are_closed() -> None:
    server, _ = start()
    links = [server.thread.connect_own() for _ in range(MAX_OWN + 1)]
    links[-1].settimeout(PATIENCE_S)
    assert links[-1].recv(1) == b""
    for link in links:
        link.close()
    server.close()


def test_commands_of_another_thread_arrive_in_order() -> None:
    server, sink = start()
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(PATIENCE_S)
        for number in range(100):
            server.publish(1, number, b"x")
        times: list[int] = []
        while len(times) < 100:
            message = wire.decode_server(client.recv(timeout=PATIENCE_S))
            if isinstance(message, ms.MessageData):
                times.append(message.time_ns)
        assert times == list(range(100))
    server.close()


def test_data_and_other_commands_do_not_overtake_each_other() -> None:
    server, sink = start()
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(PATIENCE_S)
        for number in range(200):
            for _ in range(number % 3):
                server.post(ev.SendToClient(1, ms.Status(StatusLevel.INFO, str(number))))
            server.publish(1, number, b"x")
        received: list[str] = []
        while received.count("data 199") < 1:
            message = wire.decode_server(client.recv(timeout=PATIENCE_S))
            if isinstance(message, ms.MessageData):
                received.append(f"data {message.time_ns}")
            elif isinstance(message, ms.Status):
                received.append(message.message)
        assert received == [word for n in range(200) for word in [str(n)] * (n % 3) + [f"data {n}"]]
    server.close()


def test_a_thread_that_publishes_does_not_wait_for_a_busy_event_loop() -> None:
    class Busy(Sink):
        def __init__(self) -> None:
            super().__init__()
            self.may_go_on = threading.Event()

        def post(self, event: ev.Event) -> None:
            super().post(event)
            assert self.may_go_on.wait(PATIENCE_S)

    sink = Busy()
    server = Served(sink)
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(PATIENCE_S)
        server.publish(1, 7, b"x")
        server.post(ev.SendToClient(1, ms.Status(StatusLevel.INFO, "sent")))
        sink.may_go_on.set()
        while not isinstance(message := wire.decode_server(client.recv(timeout=PATIENCE_S)), ms.MessageData):
            pass
        assert message.time_ns == 7
        assert wire.decode_server(client.recv(timeout=PATIENCE_S)) == ms.Status(StatusLevel.INFO, "sent")
    server.close()


def test_data_of_another_thread_arrives_with_tls(tmp_path: Path) -> None:
    cert, key = make_certificate(tmp_path)
    tls = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    tls.load_cert_chain(cert, key)
    sink = Sink()
    server = Served(sink, tls=tls)
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"wss://localhost:{server.port}", subprotocols=SUBPROTOCOLS, ssl=trusting(cert)) as client:
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(PATIENCE_S)
        for number in range(100):
            server.publish(1, number, number.to_bytes(4, "little") * 500)
        numbers: list[int] = []
        while len(numbers) < 100:
            message = wire.decode_server(client.recv(timeout=PATIENCE_S))
            if isinstance(message, ms.MessageData):
                assert message.payload == message.time_ns.to_bytes(4, "little") * 500
                numbers.append(message.time_ns)
        assert numbers == list(range(100))
        server.close()
        with pytest.raises(ConnectionClosed, match="1001"):
            client.recv(timeout=PATIENCE_S)


def test_a_command_that_cannot_be_encoded_harms_neither_its_sender_nor_later_ones(
    caplog: pytest.LogCaptureFixture,
) -> None:
    server, sink = start()
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(PATIENCE_S)
        server.post(ev.SendToClient(1, ms.ParameterValues((ms.Parameter("/n.p", float("nan")),))))
        server.publish(1, 7, b"x")
        while not isinstance(message := wire.decode_server(client.recv(timeout=PATIENCE_S)), ms.MessageData):
            pass
        assert message.time_ns == 7
    server.close()
    assert caplog.messages == ["internal error (please report): SendToClient failed"]


def test_a_thread_that_sends_without_pauses_does_not_block_new_clients() -> None:
    server, _ = start()
    server.post(ev.AddChannels((CHANNEL,)))
    is_enough = threading.Event()

    def send() -> None:
        while not is_enough.is_set():
            server.publish(1, 0, bytes(100))

    sender = threading.Thread(target=send)
    sender.start()
    try:
        with ExitStack() as clients:
            for _ in range(2):
                client = clients.enter_context(
                    connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS, close_timeout=0)
                )
                client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
                while not isinstance(wire.decode_server(client.recv(timeout=PATIENCE_S)), ms.MessageData):
                    pass
    finally:
        is_enough.set()
        sender.join()
        server.close()


COUNTING = """
import sys
from websockets.sync.client import connect
from thymio_sim_ros.bridge import SUBPROTOCOLS
from thymio_sim_ros.bridge.protocol import messages as ms, wire

with connect(f"ws://127.0.0.1:{sys.argv[1]}", subprotocols=SUBPROTOCOLS, close_timeout=0) as client:
    client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
    count = 0
    while count < int(sys.argv[2]):
        frame = client.recv()
        count += isinstance(frame, bytes)
    print("done")
"""


def test_a_client_that_keeps_reading_gets_a_fair_share_of_too_many_messages() -> None:
    count, most_per_arrival = 10_000, 100
    server, sink = start()
    server.post(ev.AddChannels((CHANNEL,)))
    command = [sys.executable, "-c", COUNTING, str(server.port), str(count)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as client:
        assert client.stdout is not None
        watch = threading.Thread(target=client.wait)
        watch.start()
        number = 0
        while watch.is_alive() and number < count * most_per_arrival:
            number += sink.subscribed.is_set()
            server.publish(1, number, bytes(1000))
        client.kill()
        watch.join()
        arrived = client.stdout.read()
    server.close()
    assert arrived, f"fewer than {count} of {number} messages arrived"


def test_closing_ends_the_thread_and_closes_connections() -> None:
    before = set(threading.enumerate())
    server, _ = start()
    started = set(threading.enumerate()) - before
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:
        client.recv(timeout=PATIENCE_S)
        server.close()
        with pytest.raises(ConnectionClosed, match="1001"):
            client.recv(timeout=PATIENCE_S)
    assert started
    assert not any(thread.is_alive() for thread in started)


def test_closing_twice_and_posting_afterwards_do_nothing() -> None:
    server, _ = start()
    server.close()
    server.close()
    server.post(ev.AddChannels((CHANNEL,)))
