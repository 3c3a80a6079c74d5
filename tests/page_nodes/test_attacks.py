"""Pages and programs that want more than they may: the suite stays as it is, and nothing is left behind."""

from __future__ import annotations

import contextlib
import http.client
import json
import os
import queue
import select
import signal
import socket
import sys
import threading
import urllib.error
import urllib.request
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus

from tests.page_nodes.page import Page
from tests.patience import PATIENCE_S, until
from tests.processes import SUITE, Process, free_port, wait_for_port
from tests.systems import posix
from thymio_sim_ros.page_nodes.process import LEVELS, NodeProcess
from thymio_sim_ros.page_nodes.program import NodeProgram

pytestmark = [pytest.mark.process, posix]
linux = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="isolation needs Linux")

FULL, WATCH = "full-token", "watch-token"
MARK = "left_behind_by_a_node"


@contextlib.contextmanager
def running(folder: Path, *arguments: str, **variables: str) -> Iterator[tuple[int, Process]]:
    port = free_port()
    world = ("--playground", "base", "--program", "none", "--no-foxglove-port", "--port", str(port))
    suite = Process(folder, SUITE, "--portable", *world, *arguments, variables=variables)
    try:
        wait_for_port(port)
        yield port, suite
    finally:
        suite.end()


@pytest.fixture(scope="module")
def port(tmp_path_factory: pytest.TempPathFactory) -> Iterator[int]:
    """A suite without options."""
    with running(tmp_path_factory.mktemp("suite")) as (port, _):
        yield port


def status(port: int, **how: str) -> int:
    """The HTTP status with which a page is refused."""
    with pytest.raises(InvalidStatus) as refused, Page(port, **how):
        pass
    return refused.value.response.status_code


def permission(port: int, token: str = "") -> dict[str, object]:
    request = urllib.request.Request(f"http://localhost:{port}/page-node.json")
    if token:
        request.add_header("Authorization", f"Bearer {token}")
    with urllib.request.urlopen(request, timeout=PATIENCE_S) as answer:
        found: dict[str, object] = json.load(answer)
        return found


def processes_with(mark: str) -> list[int]:
    found = []
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        with contextlib.suppress(OSError):
            if mark.encode() in path.read_bytes():
                found.append(int(path.parent.name))
    return found


# --- pages ---


def test_a_page_runs_a_node_and_gets_its_output(port: int) -> None:
    with Page(port) as page:
        output, ended = page.result("print('grüezi')\nimport rclpy\nrclpy.init()\nprint(rclpy.ok())")
    assert output == "grüezi\nTrue\n"
    assert ended == {"op": "ended", "code": 0, "reason": ""}


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "http://localhost:3000", "https://app.foxglove.dev", "null", "file://"]
)
def test_a_foreign_page_is_refused(port: int, origin: str) -> None:
    assert status(port, origin=origin) == 403


def test_a_name_that_leads_to_this_computer_is_refused(port: int) -> None:
    """As in DNS rebinding, where the page of a foreign name is, for the browser, of the same origin."""
    host = f"evil.example:{port}"
    handshake = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    handshake |= {"Sec-WebSocket-Key": "x3JJHMbDL1EzLkh9GBhXDw==", "Host": host, "Origin": f"http://{host}"}
    with contextlib.closing(http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)) as connection:
        connection.request("GET", "/page-node", headers=handshake)
        assert connection.getresponse().status == 403


@pytest.mark.parametrize("header", ["X-Forwarded-For", "Forwarded", "Via"])
def test_what_a_proxy_passes_on_is_not_of_this_computer(port: int, header: str) -> None:
    assert status(port, **{header: "192.0.2.7"}) == 403


def test_with_a_token_only_the_right_one_runs_nodes(tmp_path: Path) -> None:
    tokens = {"THYMIO_SIM_TOKEN": FULL, "THYMIO_SIM_READ_ONLY_TOKEN": WATCH}
    with running(tmp_path, **tokens) as (port, _):
        assert status(port) == 401
        assert status(port, token="another-token") == 401
        assert status(port, token=WATCH) == 403
        assert status(port, token=FULL, origin="http://evil.example") == 403
        assert permission(port, WATCH) == {"right": "readOnly", "may_run": False}
        assert permission(port, FULL) == {"right": "local", "may_run": True}
        with pytest.raises(urllib.error.HTTPError, match="401"):
            permission(port)
        with Page(port, token=FULL) as page:
            assert page.result("print(1)")[0] == "1\n"


@pytest.mark.slow
def test_without_nodes_no_one_runs_them(tmp_path: Path) -> None:
    with running(tmp_path, "--no-nodes") as (port, _):
        assert permission(port) == {"right": "off", "may_run": False}
        assert status(port) == 403


@pytest.mark.slow
@linux
def test_behind_a_proxy_nodes_run_only_for_all_and_in_isolation(tmp_path: Path) -> None:
    forwarded = {"X-Forwarded-For": "192.0.2.7", "X-Forwarded-Host": "school.example"}
    proxied = ("--trusted-proxy", "127.0.0.1")
    with running(tmp_path, *proxied, THYMIO_SIM_TOKEN=FULL) as (port, _):
        assert status(port, token=FULL, origin="http://school.example", **forwarded) == 403
    with (
        running(tmp_path, *proxied, "--nodes", THYMIO_SIM_TOKEN=FULL) as (port, _),
        Page(port, token=FULL, origin="http://school.example", **forwarded) as page,
    ):
        page.send({"op": "run", "text": "print(1)"})
        message = page.next("ready", "ended")
        assert message == {"op": "ready", "level": "namespaces"} or message["reason"] == "isolation"


@pytest.mark.parametrize(
    "message", [b"\xff\xfe", "{", "[" * 100_000, "[]", '{"op": "exec"}', '{"op": {}}', '"run"', b"{}"]
)
def test_what_is_no_message_closes_the_connection(port: int, message: str | bytes) -> None:
    with Page(port) as page:
        page.send(message)
        with pytest.raises(ConnectionClosed):
            page.next("ready")


def test_what_is_no_program_is_refused_and_the_page_goes_on(port: int) -> None:
    with Page(port) as page:
        for text in ("a\0b", "'\ud800'", "#" * 100_001):
            page.send({"op": "run", "text": text})
            ended = page.next("ended")
            assert ended["reason"] == "refused"
            assert "expected" in ended["text"]
        assert page.result("print(2)")[0] == "2\n"


def test_a_message_beyond_all_limits_closes_the_connection(port: int) -> None:
    with Page(port) as page:
        page.send({"op": "run", "text": "#" * 1_000_000})
        with pytest.raises(ConnectionClosed):
            page.next("ended")


@pytest.mark.slow
def test_a_node_that_is_slow_to_start_gets_its_connection(tmp_path: Path) -> None:
    """Its connection is made before its interpreter starts; the ports of pages close those that are silent."""
    with running(tmp_path) as (port, _), Page(port) as page:
        page.send({"op": "run", "text": "import rclpy\nrclpy.init()\nprint(4)"})
        node = until(lambda: processes_with("page_node.program"))[0]
        os.kill(node, signal.SIGSTOP)
        silent = socket.create_connection(("127.0.0.1", port))
        silent.settimeout(PATIENCE_S)
        assert silent.recv(1) == b""  # the time limit of silent connections is over
        silent.close()
        os.kill(node, signal.SIGCONT)
        page.next("ready")
        page.send({"op": "begin"})
        assert page.rest()[0] == "4\n"


# --- programs ---


def test_a_robot_has_one_node(port: int) -> None:
    with Page(port) as page, Page(port) as other:
        page.start("import time\ntime.sleep(1000)")
        other.start("print('mine')\nimport time\ntime.sleep(1000)")
        assert page.next("ended")["reason"] == "replaced"
        other.until("mine")
        other.send({"op": "stop"})
        assert other.next("ended")["reason"] == ""


BOMB = """
import os, time
while True:
    try:
        os.fork()
    except OSError:
        print("full", flush=True)
        time.sleep(0.2)
"""


@linux
def test_a_fork_bomb_stays_in_its_limits_and_ends(port: int) -> None:
    with Page(port) as page:
        page.start(BOMB)
        page.until("full")
        page.send({"op": "stop"})
        page.next("ended")
        with Page(port) as other:
            assert other.result("print(3)")[0] == "3\n"


def test_too_much_memory_ends_the_node(port: int) -> None:
    with Page(port) as page:
        output, ended = page.result("kept = []\nwhile True:\n    kept.append(bytearray(b'x' * 50_000_000))\n")
    assert "MemoryError" in output or ended["reason"] == "memory"


def test_endless_output_waits_for_the_page_and_can_be_stopped(port: int) -> None:
    with Page(port) as page:
        page.start("while True:\n    print('x' * 1000)")
        page.until("x" * 1000)
        page.send({"op": "stop"})
        _, ended = page.rest()
        assert ended["reason"] == ""


def test_a_loop_without_end_can_be_stopped(port: int) -> None:
    with Page(port) as page:
        page.start(
            "print('on', flush=True)\nwhile True:\n    try:\n        while True: pass\n    except BaseException: pass\n"
        )
        page.until("on")
        page.send({"op": "stop"})
        assert page.next("ended")["reason"] == ""


CLEANS_UP = """
import time
print("on", flush=True)
try:
    time.sleep(1000)
finally:
    print("stopped the motors", flush=True)
"""


def connected_with(port: int) -> socket.socket | int:
    """The way of a node to a suite in another process."""
    if not sys.platform.startswith("linux"):
        return port
    theirs, ours = socket.socketpair()
    threading.Thread(target=_pass_on, args=(ours, port), daemon=True).start()
    return theirs


def _pass_on(node: socket.socket, port: int) -> None:
    """Connect a node with a suite as soon as it begins to speak: the suite closes connections that are silent."""
    select.select([node], [], [])
    with node, socket.create_connection(("127.0.0.1", port)) as suite:
        other = {node: suite, suite: node}
        while True:
            for end in select.select([node, suite], [], [])[0]:
                if not (data := end.recv(65_536)):
                    return
                other[end].sendall(data)


@pytest.mark.parametrize("level", LEVELS)
def test_a_stop_lets_a_program_clean_up_at_each_level_of_isolation(port: int, level: str) -> None:
    events: queue.Queue[Mapping[str, Any]] = queue.Queue()
    node = NodeProcess(NodeProgram("a.py", CLEANS_UP), (level,), events.put, lambda: connected_with(port))
    output = ""
    while (event := events.get(timeout=PATIENCE_S))["event"] != "ended":
        output += event.get("text", "")
        if event["event"] == "ready":
            node.begin()
        elif output.endswith("on\n"):
            node.stop()
    if event["reason"] == "isolation":
        pytest.skip(f"this machine gives no {level}")
    assert output.splitlines()[:2] == ["on", "stopped the motors"]


BEHIND = f"""
import subprocess, sys, time
code = "import os, time; os.close(1); time.sleep(1000)"
subprocess.Popen([sys.executable, "-c", code, "{MARK}"], start_new_session=True)
print("started", flush=True)
time.sleep(1000)
"""


@linux
@pytest.mark.parametrize("end", ["stop", "leave"])
def test_nothing_of_a_node_is_left_behind(port: int, end: str) -> None:
    with Page(port) as page:
        page.start(BEHIND)
        page.until("started")
        until(lambda: processes_with(MARK))
        if end == "stop":
            page.send({"op": "stop"})
            page.next("ended")
    until(lambda: not processes_with(MARK))


@pytest.mark.slow
@linux
@pytest.mark.parametrize("number", ["SIGINT", "SIGKILL"])
def test_nothing_of_a_node_is_left_when_the_suite_ends(tmp_path: Path, number: str) -> None:
    with running(tmp_path) as (port, suite), Page(port) as page:
        page.start(BEHIND)
        page.until("started")
        until(lambda: processes_with(MARK))
        os.kill(suite.pid, getattr(signal, number))
        until(lambda: not processes_with(MARK))


READS = """
import ctypes, errno, os, socket
from pathlib import Path
for path in ({secret!r}, {program!r}, "/etc/shadow", "/home", "/proc/1/environ"):
    try:
        found = os.listdir(path) if os.path.isdir(path) else Path(path).read_bytes()
        print("read", path, found if path != "/proc/1/environ" else "other")
    except OSError:
        print("closed", path)
for address in (("127.0.0.1", {port}), ("192.0.2.1", 80)):
    try:
        socket.create_connection(address, timeout=1)
        print("connected", address)
    except OSError:
        print("no network", address)
libc = ctypes.CDLL(None)
for number in range(3, 100):  # an inherited connection belongs to the network in which it was made
    try:
        inherited = socket.socket(fileno=os.dup(number))
        libc.connect(inherited.fileno(), bytes(16), 16)  # AF_UNSPEC: as if it had never been connected
        if inherited.family == socket.AF_INET and inherited.connect_ex(("127.0.0.1", {port})) in (0, errno.EINPROGRESS):
            print("connected by", number)
    except OSError:
        pass
print("end")
"""


@linux
def test_an_isolated_node_finds_neither_files_of_the_user_nor_a_network(port: int, tmp_path: Path) -> None:
    secret = tmp_path / "secret.txt"
    secret.write_text("secret")
    with Page(port) as page:
        page.send({"op": "run", "text": READS.format(secret=str(secret), program=str(Path(__file__)), port=port)})
        if page.next("ready", "ended").get("level") != "namespaces":
            pytest.skip("this machine gives no namespaces")
        page.send({"op": "begin"})
        output, _ = page.rest()
    assert "read " not in output
    assert "connected" not in output
    assert output.endswith("end\n")


def test_input_and_arguments_of_the_program_are_empty(port: int) -> None:
    with Page(port) as page:
        output, ended = page.result("import sys\nprint(sys.argv)\ninput()", name="my node.py", namespace="/thymio_1")
    assert output.startswith("['my node.py', '--ros-args', '-r', '__ns:=/thymio_1']")
    assert "EOFError" in output
    assert ended["code"] == 1
