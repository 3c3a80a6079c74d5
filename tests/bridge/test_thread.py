"""The server in a thread of its own."""

from __future__ import annotations

import socket
import threading

import pytest
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import connect

from thymio_sim_ros.bridge import SUBPROTOCOLS, ServerInfo, ServerThread, wire
from thymio_sim_ros.bridge import events as ev
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.thread import listen

CHANNEL = ms.Channel(1, "/t", "cdr", "std_msgs/msg/String", "string data", "ros2msg")
DEADLINE_S = 20.0


class Sink:
    """Tells when somebody subscribes."""

    is_full = False

    def __init__(self) -> None:
        self.subscribed = threading.Event()

    def post(self, event: ev.Event) -> None:
        """Take an event."""
        if isinstance(event, ev.ChannelWanted):
            self.subscribed.set()


def start(port: int = 0) -> tuple[ServerThread, Sink]:
    sink = Sink()
    return ServerThread(ServerInfo("test", ()), sink, port=port), sink


def test_the_port_is_bound_when_the_constructor_returns_and_free_after_close() -> None:
    server, _ = start()
    with pytest.raises(OSError, match=rf"cannot listen on 127\.0\.0\.1:{server.port}: address already in use"):
        start(server.port)
    server.close()
    again, _ = start(server.port)
    again.close()


def test_an_address_that_is_not_ours_is_refused_by_name() -> None:
    with pytest.raises(OSError, match=r"cannot listen on 192\.0\.2\.1:8765"):
        listen("192.0.2.1", 8765)


def test_answers_are_not_held_back_by_nagles_algorithm() -> None:
    with listen("127.0.0.1", 0) as listener:
        assert listener.proto == socket.IPPROTO_TCP  # what asyncio asks for before it sets TCP_NODELAY


def test_commands_of_another_thread_arrive_in_order() -> None:
    server, sink = start()
    server.post(ev.AddChannels((CHANNEL,)))
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:  # type: ignore[arg-type]  # plain strings
        client.send(wire.encode_client(ms.Subscribe((ms.Subscription(1, 1),))))
        assert sink.subscribed.wait(DEADLINE_S)
        for number in range(100):
            server.post(ev.Data(1, number, b"x"))
        times: list[int] = []
        while len(times) < 100:
            message = wire.decode_server(client.recv(timeout=DEADLINE_S))
            if isinstance(message, ms.MessageData):
                times.append(message.time_ns)
        assert times == list(range(100))
    server.close()


def test_closing_ends_the_thread_and_says_goodbye_to_clients() -> None:
    before = set(threading.enumerate())
    server, _ = start()
    with connect(f"ws://127.0.0.1:{server.port}", subprotocols=SUBPROTOCOLS) as client:  # type: ignore[arg-type]  # plain strings
        client.recv(timeout=DEADLINE_S)
        server.close()
        with pytest.raises(ConnectionClosed, match="1001"):
            client.recv(timeout=DEADLINE_S)
    assert set(threading.enumerate()) == before


def test_closing_twice_and_posting_afterwards_do_nothing() -> None:
    server, _ = start()
    server.close()
    server.close()
    server.post(ev.AddChannels((CHANNEL,)))
