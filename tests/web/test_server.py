"""The running server: answers, and limits for clients."""

from __future__ import annotations

import concurrent.futures
import contextlib
import gzip
import http.client
import socket
import threading

import pytest

from tests.bridge.certificates import make_certificate, trusting
from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import connections as places
from thymio_sim_ros.bridge.connections import Phase
from thymio_sim_ros.bridge.tls import tls_context
from thymio_sim_ros.web import Content, ServerThread, Settings

pytestmark = pytest.mark.process

SCRIPT = "export {};" * 20_000


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "assets").mkdir()
    (tmp_path / "index.html").write_text("<!doctype html><title>Thymio</title>")
    (tmp_path / "assets" / "index-DGs6OHeF.js").write_text(SCRIPT)
    return tmp_path


@pytest.fixture
def warnings():
    return []


@pytest.fixture
def serve(folder, warnings):
    with contextlib.ExitStack() as stack:

        def start(address="localhost", max_connections=768, **settings):
            server = ServerThread(warn=warnings.append, connections=max_connections)
            stack.callback(server.close)
            server.mount_page(Content(folder, b"{}"), Settings(**settings))
            return server.listen(address, 0)[1]

        yield start


def ask(port, path="/", method="GET", host="127.0.0.1", **headers):
    connection = http.client.HTTPConnection(host, port, timeout=PATIENCE_S)
    connection.request(method, path, headers={name.replace("_", "-"): value for name, value in headers.items()})
    response = connection.getresponse()
    body = response.read()
    connection.close()
    return response, body


def talk(port, *words):
    """The answers of the server to these bytes until it closes the connection."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as connection:
        for word in words:
            connection.sendall(word)
        with contextlib.suppress(ConnectionResetError):
            return b"".join(iter(lambda: connection.recv(65536), b""))
    return b""


def test_hashed_files_are_kept_by_the_browser_and_others_asked_for_again(serve):
    port = serve()
    response, body = ask(port, "/assets/index-DGs6OHeF.js?v=1")
    assert body.decode() == SCRIPT
    assert "immutable" in response.headers["Cache-Control"]
    response, _ = ask(port, "/")
    assert response.headers["Cache-Control"] == "no-cache"


@pytest.mark.parametrize("weak", ["", "W/"])
def test_a_cached_document_is_not_sent_again(serve, weak):
    port = serve()
    for wanted in ("gzip", "identity"):
        response, body = ask(port, "/assets/index-DGs6OHeF.js", Accept_Encoding=wanted)
        assert (gzip.decompress(body) if wanted == "gzip" else body).decode() == SCRIPT
        tag = weak + response.headers["ETag"]
        again, body = ask(port, "/assets/index-DGs6OHeF.js", Accept_Encoding=wanted, If_None_Match=f'"other", {tag}')
        assert (again.status, body, again.headers["ETag"]) == (304, b"", response.headers["ETag"])
    assert ask(port, "/", If_None_Match='"other"')[0].status == 200


def test_every_answer_protects_the_page_and_hides_the_server(serve):
    port = serve()
    for path, status in (("/", 200), ("/config.json", 200), ("/nothing", 404)):
        response, _ = ask(port, path)
        assert response.status == status
        assert response.headers["X-Content-Type-Options"] == "nosniff"
        assert response.headers["Referrer-Policy"] == "no-referrer"
        assert response.headers["Server"] == "thymio-sim"
    policy = ask(port, "/")[0].headers["Content-Security-Policy"]
    assert "frame-ancestors 'self'" in policy
    assert f"connect-src 'self' ws://127.0.0.1:{port} wss://127.0.0.1:{port};" in policy


def test_a_page_whose_bridge_has_another_port_may_connect_to_it(serve):
    policy = ask(serve(foxglove_port=1234), "/")[0].headers["Content-Security-Policy"]
    assert "connect-src 'self' ws://127.0.0.1:1234 wss://127.0.0.1:1234;" in policy


def test_a_page_behind_a_proxy_may_connect_to_the_address_of_the_proxy(serve):
    policy = ask(serve(is_loopback=False), "/", Host="school.example")[0].headers["Content-Security-Policy"]
    assert "connect-src 'self' ws://school.example wss://school.example;" in policy


@pytest.mark.parametrize("method", ["POST", "PUT", "DELETE", "OPTIONS", "TRACE"])
def test_only_get_and_head_are_answered(serve, method):
    response, _ = ask(serve(), method=method)
    assert (response.status, response.headers["Allow"]) == (405, "GET, HEAD")
    assert response.headers["Connection"] == "close"


def test_a_client_that_sends_a_large_body_gets_the_answer_and_the_end_of_its_connection(serve):
    port = serve()
    with contextlib.closing(http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)) as connection:
        connection.request("POST", "/", bytes(20 << 20))
        response = connection.getresponse()
        assert response.status == 405
        response.read()
        assert response.will_close
    assert ask(port)[0].status == 200


def test_a_connection_serves_many_requests(serve):
    connection = http.client.HTTPConnection("127.0.0.1", serve(), timeout=PATIENCE_S)
    for path in ("/", "/nothing", "/assets/index-DGs6OHeF.js", "/"):
        connection.request("GET", path)
        response = connection.getresponse()
        response.read()
        assert response.version == 11
        assert not response.will_close
    connection.close()


@pytest.mark.parametrize("host", ["127.0.0.1", "::1"])
def test_both_loopbacks_are_served(serve, host):
    port = serve()
    try:
        response, _ = ask(port, host=host)
    except OSError:
        if host == "127.0.0.1" or _has_ipv6():
            raise
        pytest.skip("no IPv6 here")
    assert response.status == 200
    policy = response.headers["Content-Security-Policy"]
    assert ("ws: wss:" in policy) is (host == "::1")


def _has_ipv6():
    with contextlib.suppress(OSError), socket.socket(socket.AF_INET6) as probe:
        probe.bind(("::1", 0))
        return True
    return False


@pytest.mark.parametrize(
    ("host", "status"),
    [
        ("localhost", 200),
        ("LOCALHOST:8080", 200),
        ("page.localhost", 200),
        ("127.3.2.1:80", 200),
        ("[::1]:8080", 200),
        ("mine.example", 200),
        ("evil.example", 403),
        ("evil.example:8080", 403),
        ("localhost.evil.example", 403),
        ("192.168.1.2", 403),
        ("a b", 403),
        ("", 403),
    ],
)
def test_on_loopback_a_foreign_name_is_rejected(serve, warnings, host, status):
    port = serve(allowed_hosts=("mine.example",))
    for _ in range(3):
        response, body = ask(port, Host=host)
        assert response.status == status
    assert (b"Thymio" in body) is (status == 200)
    assert len(warnings) == (status == 403)


def test_in_the_network_every_host_name_is_accepted(serve):
    assert ask(serve("0.0.0.0", is_loopback=False), Host="class-pc.school:8080")[0].status == 200


@pytest.mark.parametrize(
    "request_head",
    [
        b"\x00\x01\x02\r\n\r\n",
        b"GET\r\n\r\n",
        b"GET / HTTP/9.9\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: a\r\nContent-Length: -1\r\n\r\n",
        b"GET / HTTP/1.1\r\nHost: localhost\r\nX: " + b"a" * 100_000 + b"\r\n\r\n",
        b"GET /" + b"a" * 100_000 + b" HTTP/1.1\r\n\r\n",
        b"GET / HTTP/1.1\r\n" + b"".join(b"X-%d: 1\r\n" % number for number in range(20_000)) + b"\r\n",
        b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + b"\x00" * 600 + b"\r\n\r\n",
    ],
    ids=["bytes", "word", "version", "length", "header", "target", "headers", "tls"],
)
def test_invalid_requests_are_rejected_without_echo_and_without_log(serve, warnings, request_head):
    port = serve()
    said = talk(port, request_head)
    assert said == b"" or said.startswith((b"HTTP/1.1 400", b"HTTP/1.0 400"))
    assert b"aaaa" not in said
    assert b"Python" not in said
    assert b"aiohttp" not in said
    assert ask(port)[0].status == 200
    assert warnings == []


def test_a_body_that_never_arrives_does_not_block(serve):
    port = serve()
    said = talk(port, b"POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000000\r\n\r\nx")
    assert said.startswith(b"HTTP/1.1 405")


@pytest.mark.parametrize("begin", [b"", b"GET / HTTP/1.1\r\nHost: local"])
def test_a_client_without_a_complete_request_is_disconnected(serve, monkeypatch, begin):
    monkeypatch.setitem(places.TIME_LIMIT_S, Phase.SILENT, 0.2)
    monkeypatch.setitem(places.TIME_LIMIT_S, Phase.READING, 0.2)
    assert talk(serve(), begin) == b""


def test_an_idle_client_is_disconnected_after_its_time_limit(serve, monkeypatch):
    monkeypatch.setitem(places.TIME_LIMIT_S, Phase.IDLE, 0.2)
    said = talk(serve(), b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    assert said.startswith(b"HTTP/1.1 200")


def test_a_client_that_does_not_read_is_disconnected(serve, folder, monkeypatch):
    (folder / "large.bin").write_bytes(bytes(8_000_000))
    monkeypatch.setitem(places.TIME_LIMIT_S, Phase.STALLED, 0.2)
    monkeypatch.delitem(places.MIN_WAIT_S, Phase.STALLED)
    port = serve(max_connections=1)
    with socket.socket() as connection:
        connection.settimeout(PATIENCE_S)
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.connect(("127.0.0.1", port))
        connection.sendall(b"GET /large.bin HTTP/1.1\r\nHost: localhost\r\n\r\n")
        connection.recv(100)
        assert ask(port)[0].status == 200  # in the place of the other


def test_silent_clients_and_partial_requests_do_not_block_others(serve, warnings):
    port = serve(max_connections=20)
    with contextlib.ExitStack() as stack:
        for number in range(60):
            one = stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S))
            if number % 2:
                one.sendall(b"GET / HTTP/1.1\r\n")
        assert ask(port)[0].status == 200
        assert ask(port, "/assets/index-DGs6OHeF.js")[0].status == 200
    assert len(warnings) <= 1


@pytest.mark.parametrize("word", [b"", b"GET / HTTP/1.1\r\n\r\n", b"\x16\x03\x01\x02\x00\x01"])
def test_clients_without_a_handshake_of_tls_do_not_block_others(folder, warnings, tmp_path, word):
    cert, key = make_certificate(tmp_path)
    server = ServerThread(warn=warnings.append, connections=4)
    server.mount_page(Content(folder, b"{}"), Settings())
    port = server.listen("localhost", 0, tls_context(str(cert), str(key)))[1]
    with contextlib.ExitStack() as stack:
        stack.callback(server.close)
        for _ in range(6):
            stack.enter_context(socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)).sendall(word)
        connection = http.client.HTTPSConnection("localhost", port, timeout=PATIENCE_S, context=trusting(cert))
        stack.callback(connection.close)
        connection.request("GET", "/")
        assert connection.getresponse().status == 200
    assert [text for text in warnings if "internal error" in text] == []


def test_a_class_that_opens_the_page_at_the_same_time_is_served(serve):
    port = serve(max_connections=64)
    with concurrent.futures.ThreadPoolExecutor(90) as pool:
        answers = list(pool.map(lambda path: ask(port, path)[1], ["/", "/assets/index-DGs6OHeF.js"] * 90))
    assert {len(body) for body in answers} == {len(SCRIPT), len("<!doctype html><title>Thymio</title>")}


def test_closing_ends_the_thread_and_frees_the_port(folder):
    before = threading.active_count()
    server, port = page_server(folder)
    assert ask(port)[0].status == 200
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as held:
        server.close()
        server.close()
        with contextlib.suppress(ConnectionResetError):  # it was not accepted yet
            assert held.recv(1) == b""
    assert threading.active_count() <= before
    again, _ = page_server(folder, port)
    again.close()


def test_closing_before_the_server_has_started_leaves_nothing_behind(folder):
    server, port = page_server(folder)
    server.close()
    with pytest.raises(ConnectionRefusedError):
        socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S)


def page_server(folder, port=0):
    """A server and its port."""
    server = ServerThread(warn=print)
    server.mount_page(Content(folder, b"{}"), Settings())
    return server, server.listen("localhost", port)[1]
