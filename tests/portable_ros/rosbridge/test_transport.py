"""The connection with a server: waits, rejections, losses, the end."""

from __future__ import annotations

import functools
import socket
import threading
from collections.abc import Iterator

import pytest

from tests.patience import PATIENCE_S, until
from tests.portable_ros.rosbridge.memory_server import Program
from tests.portable_ros.rosbridge.socket_server import SocketServer
from tests.processes import free_port
from thymio_sim_ros.portable_ros.messages.message_class import message_type
from thymio_sim_ros.portable_ros.rosbridge import transport
from thymio_sim_ros.portable_ros.rosbridge.transport import RosbridgeError, RosbridgeTransport
from thymio_sim_ros.ros.foxglove import json_messages

pytestmark = pytest.mark.process

String = message_type("std_msgs/msg/String")


class _Client:
    """A program with a transport to a port."""

    def __init__(self, port: int, token: str = "") -> None:
        self.reports: list[str] = []
        self.program = Program()
        url = f"ws://127.0.0.1:{port}?x=secret"
        self.transport = RosbridgeTransport(self.program.graph, url, json_messages, self.reports.append, token=token)


@pytest.fixture
def client() -> Iterator[_Client]:
    made = _Client(free_port())
    yield made
    if made.transport._thread.is_alive():
        made.transport.close()


def _port(client: _Client) -> int:
    return int(client.transport._url.partition("?")[0].rpartition(":")[2])


def test_the_start_waits_for_a_server_and_says_so_once(client: _Client) -> None:
    start = threading.Thread(target=client.transport.start)
    start.start()
    until(lambda: client.reports)
    with SocketServer(_port(client)):
        start.join(PATIENCE_S)
        assert client.transport.is_connected
        assert len(client.reports) == 2
        assert client.reports[0].startswith(f"no server at ws://127.0.0.1:{_port(client)} (")
        assert client.reports[1] == f"connected to ws://127.0.0.1:{_port(client)}"
        client.transport.close()


def test_a_server_that_rejects_the_token_is_an_error_with_its_reason(client: _Client) -> None:
    with SocketServer(_port(client), "the token is wrong"), pytest.raises(RosbridgeError) as error:
        client.transport.start()
    assert str(error.value) == f"ws://127.0.0.1:{_port(client)}: the token is wrong"


def test_a_lost_connection_and_its_return_are_said_once_and_all_is_announced_again(client: _Client) -> None:
    publisher = client.program.node("student").create_publisher(String, "topic", 10)
    with SocketServer(_port(client)) as server:
        client.transport.start()
        until(lambda: "/topic" in server.topics("advertise"))
    until(lambda: client.reports)
    publisher.publish(String(data="lost"))
    with SocketServer(_port(client)) as server:
        until(lambda: "/topic" in server.topics("advertise"))
        publisher.publish(String(data="x"))
        until(lambda: "/topic" in server.topics())
        client.transport.close()
        assert server.topics().count("/topic") == 1
    address = f"ws://127.0.0.1:{_port(client)}"
    assert [one.partition(" (")[0] for one in client.reports] == [
        f"connection with {address} lost",
        f"connected to {address}",
    ]


def test_a_server_that_rejects_the_token_after_its_return_is_said_once(client: _Client) -> None:
    with SocketServer(_port(client)):
        client.transport.start()
    until(lambda: client.reports)
    with SocketServer(_port(client), "the token is wrong") as server:
        until(lambda: server.rejected >= 2)
    with SocketServer(_port(client)):
        until(lambda: client.reports[-1].startswith("connected to"))
        client.transport.close()
    assert [one.partition(": ")[2] for one in client.reports][1:] == [
        "the token is wrong; waiting for another answer",
        "",
    ]


def test_the_end_does_not_wait_for_a_server_that_does_not_answer(
    client: _Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(transport, "connect", functools.partial(transport.connect, open_timeout=None))
    with SocketServer(_port(client)):
        client.transport.start()
    until(lambda: client.reports)
    with socket.create_server(("127.0.0.1", _port(client))) as silent:
        connection, _ = silent.accept()
        with connection:
            client.transport.close()  # the handshake has not ended yet
            assert not client.transport._thread.is_alive()


def test_what_is_published_last_arrives_before_the_end(client: _Client) -> None:
    publisher = client.program.node("student").create_publisher(String, "topic", 1000)
    with SocketServer(_port(client)) as server:
        client.transport.start()
        for _ in range(1000):
            publisher.publish(String(data="x" * 1000))
        client.transport.close()
        until(lambda: server.topics().count("/topic") == 1000, lambda: server.topics().count("/topic"))
    assert not client.program.graph.is_carried
