"""The Aseba server with nodes that only record: ports, clients, limits, and anything that can arrive on a socket."""

from __future__ import annotations

import asyncio
import contextlib
import gc
import os
import random
import socket
import threading

import pytest

from aseba_vm.protocol import (
    ExecutionStateChanged,
    GetVariables,
    ListNodes,
    NodePresent,
    Run,
    UserMessage,
    Variables,
    encode,
)
from tests.network.aseba_client import AsebaClient
from tests.patience import PATIENCE_S
from thymio_sim_ros.network import aseba_server
from thymio_sim_ros.network.hub import Hub, Network
from thymio_sim_ros.network.servers import NetworkServers
from thymio_sim_ros.network.settings import NetworkSettings

pytestmark = pytest.mark.process

FUZZED = int(os.environ.get("THYMIO_FUZZ_FRAMES", "3000"))


class Nodes:
    """A node that answers at once, in the thread of the servers."""

    def __init__(self, number):
        self.number = number
        self.clients = set()
        self.is_blocked = False
        self.left = threading.Event()
        self.network = None
        self.largest_group = 0

    def connect(self, client):
        self.clients.add(client)

    def disconnect(self, client):
        self.clients.discard(client)
        self.left.set()

    def send(self, client, messages):
        self.largest_group = max(self.largest_group, len(messages))
        for message in messages:
            if isinstance(message, ListNodes):
                self.network.deliver([NodePresent(self.number, message.version)], client)
            elif isinstance(message, GetVariables) and message.node == self.number:
                self.network.deliver([Variables(self.number, message.start, (7,) * min(message.count, 256))], client)
            elif isinstance(message, Run) and message.node == self.number:
                self.network.deliver([ExecutionStateChanged(self.number, 0, 1)])

    def is_full(self, client):
        return self.is_blocked


class Bench:
    def __init__(self, *, robots=1, **settings):
        self.warnings = []
        settings = NetworkSettings(aseba_port=0, is_announced=False, **settings)
        self.thread = NetworkServers(settings, warn=self.warnings.append, info=self.warnings.append)
        self.nodes = []
        self.clients = []
        self.networks = []
        for number in range(1, robots + 1):
            self.add(number)
        self.settle()

    def add(self, number):
        nodes = Nodes(number)
        nodes.network = Network(f"robot{number}", nodes, place=number - 1, node_ids=(number,))
        self.nodes.append(nodes)
        self.networks.append(nodes.network)
        self.thread.call(self.thread.hub.add, nodes.network)

    def settle(self):
        """Wait until the thread has done all that was asked of it."""
        done = threading.Event()
        self.thread.call(done.set)
        assert done.wait(PATIENCE_S)

    def client(self, number=1):
        self.clients.append(AsebaClient(self.thread.ports[f"robot{number}"]))
        return self.clients[-1]

    def close(self):
        for client in self.clients:
            client.close()
        self.thread.close()


@pytest.fixture
def make():
    made = []

    def bench(**options):
        made.append(Bench(**options))
        return made[-1]

    yield bench
    for one in made:
        one.close()


def test_each_robot_has_a_port_and_nodes_get_the_messages_of_its_clients(make):
    bench = make(robots=2)
    assert len(set(bench.thread.ports.values())) == 2
    for number in (1, 2):
        assert bench.client(number).ask(ListNodes(0, 5), NodePresent) == NodePresent(number, 5)


def test_all_robots_on_one_port(make):
    bench = make(robots=3, is_aseba_shared=True)
    assert len(set(bench.thread.ports.values())) == 1
    client = bench.client(1)
    client.send(ListNodes(0, 5))
    assert {client.wait_for(NodePresent).source for _ in range(3)} == {1, 2, 3}
    bench.add(4)
    bench.settle()
    assert client.ask(GetVariables(0, 4, 0, 1), Variables) == Variables(4, 0, (7,))


def test_replies_go_to_the_client_that_asked_and_other_messages_to_all(make):
    bench = make()
    first, second = bench.client(), bench.client()
    first.ask(ListNodes(0, 5), NodePresent)
    assert second.ask(ListNodes(1, 9), NodePresent) == NodePresent(1, 9)
    first.send(Run(0, 1))
    assert second.wait_for(NodePresent, ExecutionStateChanged) == ExecutionStateChanged(1, 0, 1)
    assert first.wait_for(NodePresent, ExecutionStateChanged) == ExecutionStateChanged(1, 0, 1)


def test_a_frame_in_single_bytes(make):
    client = make().client()
    for byte in encode(ListNodes(0, 5)):
        client.stream.sendall(bytes([byte]))
    assert client.wait_for(NodePresent) == NodePresent(1, 5)


def test_a_client_that_leaves_is_removed(make):
    bench = make()
    client = bench.client()
    client.ask(ListNodes(0, 5), NodePresent)
    client.stream.sendall(b"\x40\x00\x00")  # and half a frame
    client.close()
    assert bench.nodes[0].left.wait(PATIENCE_S)
    assert not bench.nodes[0].clients


def test_a_robot_that_goes_takes_its_port_and_its_clients_with_it(make):
    bench = make(robots=2)
    client, other = bench.client(1), bench.client(2)
    client.ask(ListNodes(0, 5), NodePresent)
    bench.thread.call(bench.thread.hub.remove, bench.networks[0])
    assert client.is_closed_by_server
    assert list(bench.thread.ports) == ["robot2"]
    assert other.ask(ListNodes(0, 5), NodePresent) == NodePresent(2, 5)


def test_a_stream_of_another_protocol_is_closed(make):
    bench = make()
    client = bench.client()
    client.stream.sendall(b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert client.is_closed_by_server
    assert "expected at most 4096" in bench.warnings[0]


def test_a_message_that_is_too_short_is_reported_and_skipped(make):
    bench = make()
    client = bench.client()
    client.stream.sendall(b"\x02\x00\x00\x00\x0b\xa0\x01\x00")
    assert client.ask(ListNodes(0, 5), NodePresent) == NodePresent(1, 5)
    assert "GetVariables" in bench.warnings[0]


def test_more_clients_than_the_limit_are_refused(make, monkeypatch):
    monkeypatch.setattr(aseba_server, "MAX_CLIENTS", 2)
    bench = make()
    kept = [bench.client(), bench.client()]
    for client in kept:
        client.ask(ListNodes(0, 5), NodePresent)
    assert bench.client().is_closed_by_server
    assert kept[0].ask(ListNodes(0, 5), NodePresent)


@pytest.mark.parametrize("begin", [b"", b"\x04\x00\x05"])
def test_connections_without_a_message_make_room_for_clients_and_the_oldest_goes_first(make, monkeypatch, begin):
    monkeypatch.setattr(aseba_server, "MAX_CLIENTS", 3)
    bench = make()
    kept = bench.client()
    kept.ask(ListNodes(0, 5), NodePresent)
    silent = []
    for _ in range(20):
        silent.append(bench.client())
        silent[-1].stream.sendall(begin)
    assert silent[0].is_closed_by_server
    other = bench.client()
    for client in (kept, other):
        assert client.ask(ListNodes(0, 5), NodePresent)
    assert silent[-2].is_closed_by_server


def test_a_client_that_does_not_read_is_disconnected_and_others_are_served(make, monkeypatch):
    monkeypatch.setattr(aseba_server, "MAX_UNSENT", 1 << 16)
    bench = make()
    slow, other = bench.client(), bench.client()
    for client in (slow, other):
        client.ask(ListNodes(0, 5), NodePresent)
    slow.stream.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    while len(bench.nodes[0].clients) == 2:
        bench.thread.call(bench.networks[0].deliver, [UserMessage(1, 0, (0,) * 250)] * 100)
        for _ in range(100):  # all of them: the other one does read
            assert other.wait_for(UserMessage)
        bench.settle()
    assert "does not read" in bench.warnings[0]
    assert other.ask(ListNodes(0, 5), NodePresent)


def flood(client, data):
    """Send until the buffers of the system are full; return whether they were before 64 MB."""
    sent = 0
    while sent < 1 << 26:
        try:
            sent += client.stream.send(data)
        except BlockingIOError:
            return True
    return False


def test_a_client_pauses_while_too_many_of_its_messages_wait(make):
    bench = make()
    client = bench.client()
    client.ask(ListNodes(0, 5), NodePresent)
    bench.nodes[0].is_blocked = True
    client.stream.setblocking(False)
    assert flood(client, encode(Run(0, 99)) * 1000)
    bench.nodes[0].is_blocked = False
    assert bench.client().ask(ListNodes(0, 5), NodePresent)  # accepted: the limit is for each client


def test_many_messages_at_once_are_handled_in_small_groups_between_those_of_others(make):
    """A quarter of a megabyte, handled at once, delayed other clients by more than a second."""
    bench = make(robots=2)
    client, other = bench.client(1), bench.client(2)
    client.ask(ListNodes(0, 5), NodePresent)
    client.stream.settimeout(PATIENCE_S)
    client.stream.sendall(encode(Run(0, 99)) * 20_000)
    assert other.ask(ListNodes(0, 5), NodePresent)
    assert client.ask(ListNodes(0, 5), NodePresent)
    assert 1 < bench.nodes[0].largest_group < 100


def test_a_port_that_is_taken_is_reported(make):
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        warnings = []
        thread = NetworkServers(
            NetworkSettings(aseba_port=port, is_announced=False), warn=warnings.append, info=warnings.append
        )
        thread.call(thread.hub.add, Network("anna", Nodes(1)))
        done = threading.Event()
        thread.call(done.set)
        assert done.wait(PATIENCE_S)
        thread.close()
    assert warnings == [f"Aseba port of anna: cannot listen on 127.0.0.1:{port}: address already in use"]


@pytest.mark.parametrize("passes", range(6))
def test_clients_that_are_being_accepted_at_the_end_are_disconnected(passes):
    async def end_while_clients_come():
        hub = Hub()
        server = aseba_server.AsebaServer(hub, NetworkSettings(aseba_port=0), lambda *_report: None)
        server.start()
        hub.add(Network("robot", Nodes(1)))
        (port,) = server.ports
        await asyncio.sleep(0)
        clients.extend(socket.create_connection(("127.0.0.1", port), PATIENCE_S) for _ in range(20))
        for _ in range(passes):  # of the loop, which accept them step by step
            await asyncio.sleep(0)
        await server.close()

    clients = []
    asyncio.run(end_while_clients_come())
    gc.collect()  # a connection that was forgotten warns, and warnings are errors
    for client in clients:
        with client, contextlib.suppress(ConnectionResetError):
            assert client.recv(1) == b""


def test_a_hub_reports_networks_to_those_who_follow_it():
    class Listener:
        def __init__(self):
            self.names = []

        def network_added(self, network):
            self.names.append(network.name)

        def network_removed(self, network):
            self.names.remove(network.name)

    hub, listener = Hub(), Listener()
    first, second = Network("a", Nodes(1)), Network("b", Nodes(2))
    hub.add(first)
    hub.follow(listener)
    hub.add(second)
    hub.remove(first)
    hub.remove(first)
    assert listener.names == ["b"]
    assert list(hub.by_name) == ["b"]
    hub.unfollow(listener)
    hub.remove(second)
    assert listener.names == ["b"]


def test_anything_may_arrive(make):
    """Mutated, cut and random frames on many connections that end in the middle; another client is not affected."""
    bench = make(robots=2)
    witness = bench.client(1)
    rng = random.Random(5)
    samples = [
        encode(message)
        for message in (ListNodes(0, 5), GetVariables(0, 1, 0, 300), Run(0, 1), UserMessage(0, 3, (1, 2, 3)))
    ]
    sent = 0
    while sent < FUZZED:
        client = bench.client(1)
        client.stream.settimeout(PATIENCE_S)
        try:
            for _ in range(rng.randrange(1, 200)):
                frame = bytearray(rng.choice(samples))
                match rng.randrange(4):
                    case 0:
                        frame[rng.randrange(len(frame))] = rng.randrange(256)
                    case 1:
                        del frame[rng.randrange(len(frame)) :]
                    case 2:
                        frame = bytearray(rng.randbytes(rng.randrange(40)))
                client.stream.sendall(frame)
                sent += 1
        except OSError:  # the server has closed a stream that it cannot read
            pass
        client.close()
        if rng.random() < 0.1:
            assert witness.ask(ListNodes(0, 5), NodePresent) == NodePresent(1, 5)
    assert witness.ask(GetVariables(0, 1, 5, 1), Variables) == Variables(1, 5, (7,))
    witness.close()
    while bench.nodes[0].clients:
        assert bench.nodes[0].left.wait(PATIENCE_S)
        bench.settle()
    assert not [warning for warning in bench.warnings if "internal error" in warning]
