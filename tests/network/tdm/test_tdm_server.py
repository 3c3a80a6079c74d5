"""The device manager on sockets: both ports, limits, slow and malicious clients."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import os
import random
import socket
import struct
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import TypeVar

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from tests.bridge.peers import LoopIterations
from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.raw_client import RawClient
from tests.network.tdm.served import Served, served
from tests.network.tdm.talk import values
from tests.patience import PATIENCE_S, until
from thymio_sim_ros.network import tdm_server
from thymio_sim_ros.network.hub import Hub
from thymio_sim_ros.network.settings import OFF, NetworkSettings
from thymio_sim_ros.network.tdm.protocol import messages as m
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode, framed
from thymio_sim_ros.network.tdm.protocol.constants import ErrorCode, Status, Watch
from thymio_sim_ros.network.tdm_peers import is_this_computer
from thymio_sim_ros.network.tdm_server import TdmServer

pytestmark = pytest.mark.process

T = TypeVar("T")

CONNECTIONS = int(os.environ.get("THYMIO_SIM_FUZZ", "4000")) // 20
"""Connections of the test with malicious clients."""


@pytest.fixture
def one() -> Iterator[Served]:
    """A device manager with one node."""
    with served(MachineNode()) as found:
        yield found


def test_a_tcp_client_is_greeted_and_pinged(one: Served) -> None:
    with RawClient(one.tcp_port, greet=False) as client:
        client.send(m.ConnectionHandshake())
        hello = client.wait_for(m.ConnectionHandshake)
        assert (hello.protocol_version, hello.max_message_size, hello.localhost_peer) == (1, 102400, True)
        (node,) = client.wait_for(m.NodesChanged, lambda message: bool(message.nodes)).nodes
        assert (node.name, node.status) == ("thymio_0", Status.AVAILABLE)
        client.wait_for(m.Ping)


def test_a_websocket_client_speaks_the_same_without_lengths(one: Served) -> None:
    with connect(f"ws://127.0.0.1:{one.ws_port}", compression=None) as client:
        client.send(encode(m.ConnectionHandshake()))
        hello, nodes = decode(client.recv(PATIENCE_S)), decode(client.recv(PATIENCE_S))
        assert isinstance(hello, m.ConnectionHandshake)
        assert nodes.nodes[0].name == "thymio_0"
        client.send(encode(m.LockNode(5, nodes.nodes[0].node_id)))
        while isinstance(found := decode(client.recv(PATIENCE_S)), m.NodesChanged):
            nodes = found
        assert found == m.RequestCompleted(5)
        assert nodes.nodes[0].status == Status.READY


def in_loop(one: Served, function: Callable[[], T]) -> T:
    """The result of a function that is called in the thread of the server."""

    async def called() -> T:
        return function()

    return asyncio.run_coroutine_threadsafe(called(), one.loop).result(PATIENCE_S)


def test_many_pings_at_once_are_handled_in_pieces(one: Served) -> None:
    """Pings without pause delayed the clients of all other servers by a tenth of a second."""
    with connect(f"ws://127.0.0.1:{one.ws_port}", compression=None) as client:
        iterations = in_loop(one, LoopIterations)
        client.socket.sendall(bytes([0x89, 0x80, 0, 0, 0, 0]) * 40_000)
        client.send(encode(m.ConnectionHandshake()))
        assert isinstance(decode(client.recv(PATIENCE_S)), m.ConnectionHandshake)
        in_loop(one, iterations.stop)
    assert iterations.count > 100


def test_connections_without_a_handshake_are_limited_and_make_room_for_clients() -> None:
    with served(MachineNode(), max_clients=2) as found:
        silent = [socket.create_connection(("127.0.0.1", found.ws_port), PATIENCE_S) for _ in range(5)]
        with contextlib.suppress(ConnectionError):
            assert silent[0].recv(1) == b""
        with connect(f"ws://127.0.0.1:{found.ws_port}") as client:
            client.send(encode(m.ConnectionHandshake()))
            assert isinstance(decode(client.recv(PATIENCE_S)), m.ConnectionHandshake)
        for one in silent:
            one.close()


def _gives_password(port: int, password: str) -> bool:
    """Whether the device manager answers a client with this password."""
    with RawClient(port, greet=False) as client:
        client.send(m.ConnectionHandshake(password=password))
        client.read()
        return bool(client.received)


def test_wrong_passwords_are_limited_and_do_not_lock_out_the_right_one(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(tdm_server, "is_this_computer", lambda address: False)
    with served(MachineNode(), password="chosen") as found:
        with ThreadPoolExecutor(25) as pool:
            assert not any(pool.map(partial(_gives_password, found.tcp_port), ["wrong"] * 75))
        assert _gives_password(found.tcp_port, "chosen")
    assert "tdm password" in dict(found.reports)


@pytest.mark.parametrize("origin", ["https://example.org", "null", "http://192.168.1.7"])
def test_foreign_web_pages_are_rejected(one: Served, origin: str) -> None:
    with pytest.raises(InvalidStatus, match="403"):
        connect(f"ws://127.0.0.1:{one.ws_port}", additional_headers={"Origin": origin})


@pytest.mark.parametrize("origin", ["http://localhost:5000", "http://127.0.0.1:8000", "file://"])
def test_pages_of_this_computer_may_connect(one: Served, origin: str) -> None:
    with connect(f"ws://127.0.0.1:{one.ws_port}", additional_headers={"Origin": origin}) as client:
        client.send(encode(m.ConnectionHandshake()))
        assert isinstance(decode(client.recv(PATIENCE_S)), m.ConnectionHandshake)


def test_allowed_web_pages_may_connect() -> None:
    with served(MachineNode(), allowed_origins=("https://example.org",)) as found:
        headers = {"Origin": "https://example.org"}
        with connect(f"ws://127.0.0.1:{found.ws_port}", additional_headers=headers) as client:
            client.send(encode(m.ConnectionHandshake()))
            assert isinstance(decode(client.recv(PATIENCE_S)), m.ConnectionHandshake)


def test_a_text_frame_ends_a_websocket_connection(one: Served) -> None:
    with connect(f"ws://127.0.0.1:{one.ws_port}") as client:
        client.send("hello")
        with pytest.raises(ConnectionClosed):
            client.recv(PATIENCE_S)


def test_requests_of_a_client_wait_for_its_compilations(one: Served) -> None:
    with RawClient(one.tcp_port, greet=False) as client:
        client.send(m.ConnectionHandshake())
        key = client.wait_for(m.NodesChanged, lambda message: bool(message.nodes)).nodes[0].node_id
        wrong = "\n".join(f"var v{number} = {number}" for number in range(60)) + "\nvv = 3"
        client.send(m.LockNode(1, key))
        client.send(m.CompileAndLoadCodeOnVM(2, key, 1, wrong, 2))
        client.send(m.CompileAndLoadCodeOnVM(3, key, 1, "motor.left.target = 7", 2))
        client.wait_for(m.RequestCompleted, lambda message: message.request_id == 1)
        failure = client.wait_for(m.CompilationResultFailure)
        assert (failure.request_id, failure.line) == (2, 60)
        client.wait_for(m.CompilationResultSuccess, lambda message: message.request_id == 3)
        client.send(m.SetVMExecutionState(4, key, 1))
        client.wait_for(m.RequestCompleted, lambda message: message.request_id == 4)
        client.send(m.WatchNode(5, key, Watch.VARIABLES))
        dump = client.wait_for(m.VariablesChanged)
        assert values(dump)["motor.left.target"] == (7,)


def test_a_lost_connection_gives_its_node_back(one: Served) -> None:
    with RawClient(one.tcp_port, greet=False) as watching:
        watching.send(m.ConnectionHandshake())
        key = watching.wait_for(m.NodesChanged, lambda message: bool(message.nodes)).nodes[0].node_id
        with RawClient(one.tcp_port) as client:
            client.send(m.LockNode(1, key))
            client.wait_for(m.RequestCompleted)
            client.socket.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))  # reset
        watching.wait_for(m.NodesChanged, lambda message: message.nodes[0].status == Status.BUSY)
        watching.wait_for(m.NodesChanged, lambda message: message.nodes[0].status == Status.AVAILABLE)


def test_more_clients_than_the_limit_are_rejected() -> None:
    with served(MachineNode(), max_clients=2) as found:
        with RawClient(found.tcp_port), RawClient(found.tcp_port), RawClient(found.tcp_port, greet=False) as third:
            third.wait_for_end()
        until(lambda: found.server.client_count == 0)
        RawClient(found.tcp_port).socket.close()


def test_silent_connections_make_room_for_clients_and_the_oldest_goes_first() -> None:
    with served(MachineNode(), max_clients=3) as found, RawClient(found.tcp_port) as greeted:
        silent = [RawClient(found.tcp_port, greet=False)]
        until(lambda: found.server.client_count == 2)
        silent.append(RawClient(found.tcp_port, greet=False))
        until(lambda: found.server.client_count == 3)
        with RawClient(found.tcp_port) as first:
            silent[0].wait_for_end()
            with RawClient(found.tcp_port) as second:
                silent[1].wait_for_end()
                for client in (greeted, first, second):
                    client.received.clear()
                    client.wait_for(m.Ping)
                with RawClient(found.tcp_port, greet=False) as third:
                    third.wait_for_end()
        for one in silent:
            one.socket.close()


def test_a_client_that_does_not_read_is_disconnected_and_others_are_served() -> None:
    with served(MachineNode(), max_unsent=200_000) as found, RawClient(found.tcp_port) as other:
        stalled = socket.socket()
        stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        stalled.connect(("127.0.0.1", found.tcp_port))
        stalled.settimeout(0.2)
        stalled.sendall(framed(encode(m.ConnectionHandshake())))
        until(lambda: found.server.client_count == 2)
        other.send(m.RequestListOfNodes())
        key = other.wait_for(m.NodesChanged, lambda message: bool(message.nodes)).nodes[0].node_id
        request = framed(encode(m.RequestNodeAsebaVMDescription(1, key))) * 20

        def is_disconnected() -> bool:
            with contextlib.suppress(OSError):
                stalled.sendall(request)
            return found.server.client_count == 1

        until(is_disconnected)
        stalled.close()
        other.send(m.RequestListOfNodes())
        other.wait_for(m.NodesChanged, lambda message: bool(message.nodes))


def _attack(chance: random.Random, port: int, samples: list[bytes]) -> None:
    """Open a connection, send something wrong, and leave in one of several ways."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as client:
        data = framed(encode(m.ConnectionHandshake())) if chance.random() < 0.7 else b""
        for _ in range(chance.randint(1, 20)):
            buffer = bytearray(chance.choice(samples))
            for _ in range(chance.randint(0, 3)):
                buffer[chance.randrange(len(buffer))] = chance.randrange(256)
            data += framed(bytes(buffer))
        if chance.random() < 0.5:
            data = data[: chance.randrange(len(data))]
        try:
            client.sendall(data)
        except OSError:
            return
        if chance.random() < 0.3:
            client.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))


def test_malicious_clients_do_not_disturb_others(one: Served) -> None:
    chance = random.Random(7)
    with RawClient(one.tcp_port, greet=False) as client:
        client.send(m.ConnectionHandshake())
        node = client.wait_for(m.NodesChanged, lambda message: bool(message.nodes)).nodes[0]
        client.send(m.LockNode(1, node.node_id))
        client.wait_for(m.RequestCompleted)
        named = (m.NamedValue("acc", b"\1\0\5\1\1\1"),)
        samples = [encode(kind()) for kind in m.MESSAGES]
        samples += [encode(m.SetVariables(1, node.node_id, named)), encode(m.WatchNode(2, node.node_id, 63))]
        samples += [encode(m.CompileAndLoadCodeOnVM(3, node.node_id, 1, "var a", 2))]
        for number in range(CONNECTIONS):
            _attack(chance, one.tcp_port, samples)
            if number % 20 == 0:
                client.send(m.LockNode(10 + number, node.node_id))
                answer = client.wait_for(m.Error, lambda message, want=10 + number: message.request_id == want)
                assert answer.error == ErrorCode.NODE_BUSY
        until(lambda: one.server.client_count == 1)


@pytest.mark.parametrize(
    ("address", "expected"),
    [
        ("127.0.0.1", True),
        ("127.3.2.1", True),
        ("::1", True),
        ("::ffff:127.0.0.1", True),
        ("192.168.1.7", False),
        ("fe80::1%eth0", False),
        ("::ffff:10.0.0.1", False),
        ("", False),
    ],
)
def test_clients_of_this_computer_have_loopback_addresses(address: str, expected: bool) -> None:
    assert is_this_computer(address) is expected


def test_a_taken_port_is_reported_and_nothing_is_served() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        reports: list[tuple[str, str]] = []
        server = TdmServer(
            Hub(), NetworkSettings(tdm_port=port, address="127.0.0.1"), lambda *report: reports.append(report)
        )
        server.start()
        assert server.port == OFF
        ((about, text),) = reports
        assert about == "tdm"
        assert text == f"Thymio Device Manager: cannot listen on 127.0.0.1:{port}: address already in use"
        asyncio.run(server.close())


@pytest.mark.parametrize("passes", range(6))
def test_clients_that_are_being_accepted_at_the_end_are_disconnected(passes: int) -> None:
    async def end_while_clients_come() -> None:
        settings = NetworkSettings(address="127.0.0.1", tdm_port=0, tdm_ws_port=0)
        server = TdmServer(Hub(), settings, lambda *_report: None)
        server.start()
        clients.extend(socket.create_connection(("127.0.0.1", server.port), PATIENCE_S) for _ in range(20))
        for _ in range(passes):  # of the loop, which accept them step by step
            await asyncio.sleep(0)
        await server.close()

    clients: list[socket.socket] = []
    asyncio.run(end_while_clients_come())
    gc.collect()  # a connection that was forgotten warns, and warnings are errors
    for client in clients:
        with client, contextlib.suppress(ConnectionResetError):
            assert client.recv(1) == b""


def test_a_removed_robot_is_disconnected(one: Served) -> None:
    with RawClient(one.tcp_port, greet=False) as client:
        client.send(m.ConnectionHandshake())
        client.wait_for(m.NodesChanged, lambda message: bool(message.nodes))
        server, network = one.server, one.networks[0].network
        one.loop.call_soon_threadsafe(lambda: server._hub.remove(network))
        client.wait_for(m.NodesChanged, lambda message: message.nodes[0].status == Status.DISCONNECTED)
