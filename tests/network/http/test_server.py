"""The running HTTP interface: real clients, streams, limits, and whom it does not answer."""

from __future__ import annotations

import asyncio
import contextlib
import http.client
import json
import os
import random
import shutil
import socket
import subprocess
import threading
from pathlib import Path

import pytest

from aseba_vm.protocol import UserMessage
from tests.network.http.robots import ServerThread
from tests.patience import PATIENCE_S, until
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.network.http import server as limits
from thymio_sim_ros.network.settings import OFF
from thymio_sim_ros.web import http_connections

pytestmark = pytest.mark.process

DATA = Path(__file__).parents[2] / "data" / "network"
PROGRAM = (DATA / "http.aesl").read_bytes()
N = "/nodes/thymio-II"
MUTATED = int(os.environ.get("THYMIO_SIM_FUZZ", "1200"))
"""Requests of the test with mutated ones."""


@pytest.fixture
def serve():
    with contextlib.ExitStack() as stack:

        def start(*names, **settings):
            server = ServerThread(names or ("",), **settings)
            stack.callback(server.end)
            if "tokens" not in settings:
                until(lambda: len(json.loads(ask(server, "GET", "/nodes").body)) == len(server.names))
            return server

        yield start


@pytest.fixture
def server(serve):
    return serve()


class Answer:
    def __init__(self, response):
        self.status, self.headers, self.body = response.status, response.headers, response.read()


def ask(server, method, target, body=None, **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE_S)
    connection.request(method, target, body, {name.replace("_", "-"): value for name, value in headers.items()})
    with contextlib.closing(connection):
        return Answer(connection.getresponse())


class EventSource:
    """A client of server-sent events, as a browser is one (HTML Living Standard, section 9.2)."""

    def __init__(self, server, target):
        self.connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE_S)
        self.connection.request("GET", target, headers={"Accept": "text/event-stream"})
        self.response = self.connection.getresponse()

    def next(self):
        """The data of the next event; None at the end of the stream."""
        data = []
        while line := self.response.readline():
            text = line.decode().rstrip("\r\n")
            if not text:
                return "\n".join(data)
            name, _, value = text.partition(":")
            assert name == "data"
            data.append(value.removeprefix(" "))
        return None

    def close(self):
        self.response.close()
        self.connection.close()


def test_a_course_in_requests(server):
    assert json.loads(ask(server, "GET", "/nodes").body)[0]["name"] == "thymio-II"
    assert ask(server, "PUT", N, PROGRAM).status == 204
    events = EventSource(server, "/events?todo=2")
    assert events.response.headers["Content-Type"] == "text/event-stream"
    assert ask(server, "GET", f"{N}/ping/3/4").status == 204
    assert ask(server, "POST", f"{N}/ping", "[5, 6]").status == 204
    assert [events.next(), events.next(), events.next()] == ["pong 3 4", "pong 5 6", None]
    events.close()
    assert ask(server, "GET", f"{N}/counter").body == b"[5]"
    assert ask(server, "GET", f"{N}/motor.left.target/100").status == 204
    assert ask(server, "GET", f"{N}/motor.left.target").body == b"[100]"
    assert ask(server, "GET", "/reset").status == 204
    assert ask(server, "GET", f"{N}/motor.left.target").body == b"[0]"
    assert server.problems == []


@pytest.mark.skipif(shutil.which("curl") is None, reason="curl is not installed")
def test_curl_needs_no_options(server, tmp_path):
    def curl(target, *options):
        words = ["curl", "-s", "-w", "%{http_code}", *options, f"http://localhost:{server.port}{target}"]
        return subprocess.run(words, capture_output=True, text=True, check=True, timeout=PATIENCE_S).stdout

    # more than 1024 bytes, for which curl expects "100 Continue" before it sends them
    program = tmp_path / "program.aesl"
    program.write_bytes(PROGRAM + b" " * 5000)
    assert curl(N, "-T", str(program)) == "204"
    assert curl(N, "-X", "PUT", "--data-binary", f"@{program}") == "204"
    assert curl(N, "-X", "PUT", "-d", "file=" + PROGRAM.decode()) == "204"
    assert curl(f"{N}/list") == "[1,2,3]200"
    assert curl(f"{N}/list", "-d", "[9]") == "204"
    assert curl(f"{N}/list") == "[9,2,3]200"
    assert curl(f"{N}/nope") == "no variable and no event 'nope' on this node\n404"
    assert curl("/nodes", "-X", "DELETE") == "DELETE is not answered; expected GET, POST, PUT, OPTIONS\n405"
    assert curl("/nodes", "-I").endswith("405")


def test_the_bridge_of_vpl_3(server):
    """The requests of VPL 3 in a page of this computer, in its order."""
    page = {"Origin": "http://127.0.0.1:8899", "Sec_Fetch_Site": "same-site"}
    node = json.loads(ask(server, "GET", "/nodes", **page).body)[0]["name"]
    assert json.loads(ask(server, "GET", f"/nodes/{node}", **page).body)["node"] == 1
    preflight = ask(server, "OPTIONS", f"/nodes/{node}", Access_Control_Request_Method="PUT", **page)
    assert preflight.status == 200
    assert "PUT" in preflight.headers["Access-Control-Allow-Methods"]
    loaded = ask(server, "PUT", f"/nodes/{node}", PROGRAM, Content_Type="text/plain", **page)
    assert loaded.status == 204
    assert loaded.headers["Access-Control-Allow-Origin"] == "http://127.0.0.1:8899"
    events = EventSource(server, "/events")
    ask(server, "GET", f"/nodes/{node}/ping/1/2", **page)
    assert events.next() == "pong 1 2"
    events.close()


def test_one_connection_serves_many_requests(server):
    connection = http.client.HTTPConnection("127.0.0.1", server.port, timeout=PATIENCE_S)
    for method, target, body in [("GET", "/nodes", None), ("PUT", N, PROGRAM), ("GET", f"{N}/list", None)] * 3:
        connection.request(method, target, body)
        response = connection.getresponse()
        assert response.status in (200, 204)
        response.read()
    connection.close()


def test_streams_end_with_their_clients(server):
    sources = [EventSource(server, "/events") for _ in range(3)]
    until(lambda: server.call(lambda: server.server._gateway.stream_count) == 3)
    for source in sources:
        source.close()
    until(lambda: server.call(lambda: server.server._gateway.stream_count) == 0)


def test_a_server_that_ends_closes_its_streams(serve):
    server = serve()
    sources = [EventSource(server, "/events") for _ in range(3)]
    until(lambda: server.call(lambda: server.server._gateway.stream_count) == 3)
    server.end()
    for source in sources:
        with contextlib.suppress(http.client.IncompleteRead, ConnectionError):
            assert source.next() is None
        source.close()
    assert server.problems == []


def test_a_client_that_does_not_read_its_stream_is_closed_and_others_get_theirs(server, monkeypatch):
    monkeypatch.setattr(limits, "MAX_QUEUED_EVENTS", 50)
    ask(server, "PUT", N, b"<network><event name='big' size='256'/><node name='thymio-II'></node></network>")
    slow = socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE_S)
    slow.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    slow.sendall(b"GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n")
    other = EventSource(server, "/events")
    until(lambda: server.call(lambda: server.server._gateway.stream_count) == 2)

    def send(number):
        server.robots[0].network.deliver([UserMessage(1, 0, (number,) * 256)])

    sent = 0
    while server.call(lambda: server.server._gateway.stream_count) == 2:
        server.call(lambda: send(1000))
        assert other.next() == "big" + " 1000" * 256
        sent += 1
        assert sent < 20_000
    other.close()
    slow.close()


def test_pages_from_elsewhere_are_refused(server):
    ask(server, "PUT", N, PROGRAM)
    for headers in (
        {"Origin": "https://evil.example"},
        {"Sec_Fetch_Site": "cross-site"},
        {"Host": "evil.example"},
        {"Origin": "null"},
    ):
        answer = ask(server, "GET", f"{N}/counter/66", **headers)
        assert answer.status == 403
        assert "Access-Control-Allow-Origin" not in answer.headers
    assert ask(server, "GET", f"{N}/counter").body == b"[5]"


def test_a_page_whose_name_is_no_text_is_refused(server):
    request = b"GET /nodes HTTP/1.1\r\nHost: localhost\r\nOrigin: http://local\x84ost\r\nConnection: close\r\n\r\n"
    assert b" 403 " in talk(server, request).split(b"\r\n")[0]
    assert server.problems == [
        ("origin", "web page from http://local\ufffdost rejected: add it to allowed_origins if it is yours")
    ]


def test_a_token_decides_on_the_network(serve):
    server = serve(tokens=Tokens("full-token", "watch-token"))
    assert ask(server, "GET", "/nodes").status == 401
    until(lambda: ask(server, "GET", "/nodes?token=full-token").body != b"[]")
    assert ask(server, "PUT", f"{N}?token=watch-token", PROGRAM).status == 403
    assert ask(server, "PUT", N, PROGRAM, Authorization="Bearer full-token").status == 204
    assert ask(server, "GET", f"{N}/counter?token=watch-token").body == b"[5]"
    for change in (f"{N}/counter/1", f"{N}/ping", "/reset"):
        assert ask(server, "GET", f"{change}?token=watch-token").status == 403
    source = EventSource(server, "/events?token=watch-token")
    ask(server, "GET", f"{N}/ping/1/2?token=full-token")
    assert source.next() == "pong 1 2"
    source.close()


def test_large_bodies_and_heads_are_refused(server, monkeypatch):
    monkeypatch.setattr(http_connections, "_LINGER_S", 0.1)  # these clients do not send the body that they announce
    head = f"PUT {N} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {limits.MAX_BODY + 1}\r\n\r\n"
    assert b" 413 " in talk(server, head.encode()).split(b"\r\n")[0]
    assert ask(server, "GET", "/nodes/" + "a" * 5000).status == 414
    assert ask(server, "GET", "/" + "a" * 20_000).status == 400
    chunked = talk(
        server, b"PUT /nodes/1 HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n",
        *[b"8000\r\n" + b" " * 0x8000 + b"\r\n"] * 40,
    )  # fmt: skip
    assert b" 413 " in chunked.split(b"\r\n")[0] or chunked == b""  # it may be closed while the client writes
    assert ask(server, "GET", "/nodes").status == 200


@pytest.mark.parametrize("size", [5 << 20, 20 << 20])
def test_a_client_that_sends_a_body_far_too_large_gets_the_reason(server, size):
    answer = ask(server, "PUT", N, b" " * size)
    assert answer.status == 413
    assert f"expected at most {limits.MAX_BODY}" in answer.body.decode()
    assert ask(server, "GET", "/nodes").status == 200


def test_a_client_that_leaves_before_the_end_of_its_body_leaves_nothing_behind(server, monkeypatch):
    monkeypatch.setattr(http_connections, "_LINGER_S", 2 * PATIENCE_S)
    with socket.create_connection(("127.0.0.1", server.port), timeout=PATIENCE_S) as connection:
        head = f"PUT {N} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {limits.MAX_BODY + 1}\r\n\r\n"
        connection.sendall(head.encode())
        assert b" 413 " in connection.recv(1 << 16)
    until(lambda: "RequestHandler.start" not in server.call(running))


def running():
    return {task.get_coro().__qualname__ for task in asyncio.all_tasks()}


def test_robots_come_and_go(serve):
    server = serve("anna", "bert")
    source = EventSource(server, "/nodes/bert/events")
    server.call(lambda: server.hub.remove(server.robots[0].network))
    assert [node["robot"] for node in json.loads(ask(server, "GET", "/nodes").body)] == ["bert"]
    server.call(lambda: server.hub.add(server.robots[0].network))
    until(lambda: len(json.loads(ask(server, "GET", "/nodes").body)) == 2)
    source.close()


def test_a_port_that_is_taken_is_reported():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        number = taken.getsockname()[1]
        server = ServerThread(address="127.0.0.1", port=number)
        server.end()
    assert server.port == OFF
    assert server.problems == [
        ("http", f"HTTP interface: [Errno 98] cannot listen on 127.0.0.1:{number}: address already in use")
    ]


def talk(server, *parts, is_whole=False):
    """The bytes of the server until it closes the connection; this side closes after the parts of a whole request."""
    found = b""
    address = ("127.0.0.1", server.port)
    with socket.create_connection(address, timeout=PATIENCE_S) as connection, contextlib.suppress(ConnectionError):
        for part in parts:
            connection.sendall(part)
        if is_whole:
            connection.shutdown(socket.SHUT_WR)
        while data := connection.recv(65536):
            found += data
    return found


def mutated(rng, request):
    """A request with some bytes changed, removed or added."""
    data = bytearray(request)
    for _ in range(rng.randrange(1, 6)):
        place = rng.randrange(len(data) + 1)
        match rng.randrange(3):
            case 0:
                data[place : place + 1] = bytes([rng.randrange(256)])
            case 1:
                del data[place : place + rng.randrange(1, 20)]
            case 2:
                data[place:place] = rng.choice(WORDS)
    return bytes(data[: rng.randrange(len(data) + 1)]) if rng.random() < 0.2 else bytes(data)


WORDS = (b"/", b"%", b"%2F", b"?todo=", b"\r\n", b"\0", b"[", b"]", b"1e999", b"-", b"9" * 30, b"HTTP/1.1", b"\xff")
REQUESTS = (
    b"GET /nodes HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /nodes/1/list/1/2/3 HTTP/1.1\r\nHost: localhost\r\nOrigin: http://localhost\r\n\r\n",
    b"POST /nodes/1/list HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n[1, 2, 3]",
    b"PUT /nodes/1 HTTP/1.1\r\nHost: localhost\r\nContent-Length: 35\r\n\r\n<network><node>a = 1</node></network>",
    b"GET /events?todo=1 HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"OPTIONS /nodes HTTP/1.1\r\nHost: localhost\r\n\r\n",
    b"GET /reset HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer abcd\r\n\r\n",
)


def test_mutated_requests_do_no_harm(server):
    ask(server, "PUT", N, PROGRAM)
    watching = EventSource(server, "/events/pong")
    rng = random.Random(1)
    answers = []

    def attack(seed):
        mine = random.Random(seed)
        requests = (mutated(mine, mine.choice(REQUESTS)) for _ in range(MUTATED // 4))
        answers.extend(talk(server, request, is_whole=True) for request in requests)

    attackers = [threading.Thread(target=attack, args=(rng.random(),)) for _ in range(4)]
    for one in attackers:
        one.start()
    for one in attackers:
        one.join()
    ask(server, "PUT", N, PROGRAM)
    ask(server, "GET", f"{N}/ping/1/2")
    assert watching.next() == "pong 1 2"
    watching.close()
    until(lambda: server.call(lambda: server.server._gateway.waiting + server.server._gateway.stream_count) == 0)
    assert [problem for problem in server.problems if problem[0] not in ("host", "origin")] == []  # mutated headers
    assert [answer for answer in answers if b" 500 " in answer[:16]] == []
