"""A class of six behind a real nginx with TLS and a path, as docs/serve-a-school.md configures it.

Other programs, attacks
on tokens, origins, paths and limits, and mistakes in the configuration.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import socket
import ssl
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect

from tests.classroom.class_support import RunningClass
from tests.network.tdm.remote_client import with_robot
from tests.nginx import PREFIX, Nginx
from tests.patience import PATIENCE_S, until
from tests.ros.test_rosbridge_clients import DATA, EXPECTED, PLACES
from thymio_sim_ros.bridge.handshake import WRONG_TOKEN
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS
from thymio_sim_ros.network.tdm.protocol import messages as tdm
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode

pytestmark = pytest.mark.process

NAMES = ["Ada", "Ben", "Eve", "Ida", "Tom", "Uma"]
OPTIONS = ("--trusted-proxy", "127.0.0.1", "--playground", "borderless", "--program", "none")


@pytest.fixture(scope="module")
def group(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """The class; all robots stand in the middle of a large playground."""
    running = RunningClass(tmp_path_factory.mktemp("class"), NAMES, arguments=OPTIONS)
    try:
        for name in NAMES:
            running.until(name.lower(), lambda one: one["phase"] == "running" and one["programs"])
        yield running
    finally:
        running.end()


@pytest.fixture(scope="module")
def proxy(group: RunningClass, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Nginx]:
    """The proxy in front of the class."""
    running = Nginx(tmp_path_factory.mktemp("proxy") / "nginx", group.port)
    yield running
    running.end()


def curl(proxy: Nginx, path: str, *options: str) -> tuple[int, str]:
    """Status and body of an answer; the path is sent as it is. Raises CalledProcessError."""
    if shutil.which("curl") is None:
        pytest.skip("curl is not installed")
    command = ["curl", "--silent", "--show-error", "--path-as-is", "--cacert", str(proxy.certificate), "--noproxy", "*"]
    written = ["--write-out", "\n%{http_code}", f"{proxy.address}{path}"]
    done = subprocess.run(
        [*command, *options, *written], capture_output=True, text=True, timeout=PATIENCE_S, check=True
    )
    body, _, status = done.stdout.rpartition("\n")
    return int(status), body


def bearer(token: str) -> tuple[str, str]:
    """The options of curl for a token."""
    return "--header", f"Authorization: Bearer {token}"


def socket_to(proxy: Nginx, path: str, *, is_foxglove: bool = True, **how: Any) -> connect:
    """A WebSocket through the proxy."""
    trust = ssl.create_default_context(cafile=proxy.certificate)
    names = SUBPROTOCOLS if is_foxglove else None
    address = f"{proxy.address}{path}".replace("https", "wss")
    return connect(address, subprotocols=names, ssl=trust, proxy=None, max_size=None, **how)


def until_closed(client: ClientConnection) -> list[tdm.Message]:
    """The messages of a device manager until it closes the connection."""
    found: list[tdm.Message] = []
    with contextlib.suppress(ConnectionClosed):
        while True:
            received = client.recv(PATIENCE_S)
            assert isinstance(received, bytes)
            found.append(decode(received))
    return found


def test_each_of_six_pupils_has_a_robot_of_its_own_for_curl(group: RunningClass, proxy: Nginx) -> None:
    def sound(pupil: str) -> str:
        return curl(proxy, f"p/{pupil}/nodes/thymio-II/event.args", *bearer(group.token_of(pupil)))[1]

    pupils = [name.lower() for name in NAMES]
    for number, pupil in enumerate(pupils):
        path = f"p/{pupil}/nodes/thymio-II/event.args"
        status, text = curl(proxy, path, *bearer(group.token_of(pupil)), "--data", f"[{number}, 7]")
        assert status < 300, text
    for number, pupil in enumerate(pupils):
        until(lambda: json.loads(sound(pupil))[:2] == [number, 7], lambda: sound(pupil))  # noqa: B023 - in this turn


def test_a_stream_of_events_arrives_at_once(group: RunningClass, proxy: Nginx) -> None:
    """The events are those of a program that curl loads."""
    token, program = (
        bearer(group.token_of("tom")),
        (
            '<!DOCTYPE aesl-source><network><event size="1" name="beat"/><node nodeId="1" name="thymio-II">'
            "timer.period[0] = 50\nonevent timer0\nemit beat 5</node></network>"
        ),
    )
    status, text = curl(proxy, "p/tom/nodes/thymio-II", *token, "--request", "PUT", "--data-binary", program)
    assert status < 300, text
    status, events = curl(proxy, "p/tom/events/beat?todo=3", *token)
    assert (status, events.count("data: beat 5")) == (200, 3)


def test_tdmclient_runs_a_program_on_the_robot_of_one_pupil(group: RunningClass, proxy: Nginx) -> None:
    async def load(node: Any) -> object:
        assert await node.compile("var found = 78\n") is None
        return await node.run()

    address = f"{proxy.address}p/eve/tdm".replace("https", "wss")
    with_robot(address, group.token_of("eve"), load)
    path = "p/{}/nodes/thymio-II/found"
    until(lambda: curl(proxy, path.format("eve"), *bearer(group.token_of("eve")))[1] == "[78]")
    assert curl(proxy, path.format("ida"), *bearer(group.token_of("ida")))[0] == 404


@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")
def test_roslib_drives_the_robot_of_one_pupil(group: RunningClass, proxy: Nginx, tmp_path: Path) -> None:
    modules = next((Path(place) for place in PLACES if place and (Path(place) / "roslib").is_dir()), None)
    if modules is None:
        pytest.skip("the npm package roslib is not installed (THYMIO_SIM_NODE_MODULES)")
    shutil.copy(DATA / "use_robot.mjs", tmp_path)
    (tmp_path / "node_modules").symlink_to(modules)
    address = f"{proxy.address}p/uma/?token={group.token_of('uma')}".replace("https", "wss")
    environment = {**os.environ, "BRIDGE_URL": address, "NODE_EXTRA_CA_CERTS": str(proxy.certificate)}
    done = subprocess.run(
        ["node", str(tmp_path / "use_robot.mjs")],
        env=environment,
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        check=False,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = [json.loads(line[1:]) for line in done.stdout.splitlines() if line.startswith("#")]
    assert {key: value for line in lines for key, value in line.items()} == EXPECTED


def test_the_token_of_one_pupil_opens_nothing_of_another(group: RunningClass, proxy: Nginx) -> None:
    ada, ben = group.token_of("ada"), group.token_of("ben")
    assert curl(proxy, "p/ada/nodes", *bearer(ben))[0] == 401
    assert curl(proxy, f"p/ada/nodes?token={ben}")[0] == 401
    assert curl(proxy, "p/ada/nodes")[0] == 401
    assert curl(proxy, "teacher/class/state", *bearer(ada))[0] == 401
    assert curl(proxy, f"teacher/class/state?token={group.known['teacher_token']}")[0] == 401  # in a header only
    with pytest.raises(InvalidStatus, match="401"), socket_to(proxy, f"p/ada/?token={ben}"):
        pass
    with socket_to(proxy, "p/ada/tdm", is_foxglove=False) as client:
        client.send(encode(tdm.ConnectionHandshake(password=ben)))
        assert not any(isinstance(message, tdm.NodesChanged) for message in until_closed(client))


def test_a_foreign_page_needs_a_token_and_is_told_so(group: RunningClass, proxy: Nginx) -> None:
    foreign = {"origin": "https://evil.example"}
    with socket_to(proxy, "p/ada/", **foreign) as client:
        assert "token" in str(client.recv(PATIENCE_S))
        with pytest.raises(ConnectionClosed):
            client.recv(PATIENCE_S)
        assert client.close_code == WRONG_TOKEN
    with pytest.raises(InvalidStatus, match="403"), socket_to(proxy, "p/ada/tdm", is_foxglove=False, **foreign):
        pass
    status, _ = curl(proxy, "p/ada/nodes", "--header", "Origin: https://evil.example")
    assert status == 401


def test_who_guesses_the_code_of_the_room_has_to_wait_whatever_address_it_claims(
    group: RunningClass, proxy: Nginx
) -> None:
    def guess(number: int) -> int:
        claim = "--header", f"X-Forwarded-For: 192.0.2.{number}"
        return curl(proxy, "room/names", *bearer(f"wrong{number}"), *claim)[0]

    with ThreadPoolExecutor(20) as pool:
        statuses = list(pool.map(guess, range(60)))
    assert set(statuses) == {401, 429}
    until(lambda: curl(proxy, "room/names", *bearer(group.known["room_code"]))[0] == 200)


@pytest.mark.parametrize(
    "path",
    [
        "p/ada/../ben/nodes",
        "p/ada/%2e%2e/ben/nodes",
        "p/ada/..%2fben/nodes",
        "p/../p/ben/nodes",
        "../p/ben/nodes",
        "p/ben/..;/ben/nodes",
        "p//ben/nodes",
        "p/ada/%2e%2e%2f%2e%2e/class.json",
        "p/..%5c..%5cclass.json",
    ],
)
def test_no_path_leads_to_another_robot_or_file(group: RunningClass, proxy: Nginx, path: str) -> None:
    status, text = curl(proxy, path, *bearer(group.token_of("ada")))
    assert status in (400, 401, 403, 404), text
    assert "thymio-II" not in text
    assert not any(token in text for token in (group.token_of("ben"), group.known["teacher_token"]))


def test_a_body_that_is_too_large_is_refused(group: RunningClass, proxy: Nginx, tmp_path: Path) -> None:
    large = tmp_path / "large"
    large.write_bytes(bytes(7_000_000))  # nginx itself refuses more than 8 MB
    given = bearer(group.known["teacher_token"])
    assert curl(proxy, "teacher/class/message", *given, "--data-binary", f"@{large}")[0] == 413


def test_no_token_is_in_the_log_of_the_proxy(group: RunningClass, proxy: Nginx) -> None:
    assert curl(proxy, f"p/ada/nodes?token={group.token_of('ada')}")[0] == 200
    until(lambda: "/p/ada/nodes" in proxy.log)
    assert "token" not in proxy.log
    assert not any(one["token"] in proxy.log for one in group.known["pupils"])


def test_a_proxy_that_does_not_remove_the_path_is_answered_by_404(group: RunningClass, tmp_path: Path) -> None:
    proxy = Nginx(tmp_path / "nginx", group.port, removes_path=False)
    try:
        assert curl(proxy, "") == (404, "There is no such file.\n")
        assert curl(proxy, "p/ada/nodes", *bearer(group.token_of("ada")))[0] == 404
    finally:
        proxy.end()


def test_an_expired_certificate_is_named_by_clients(group: RunningClass, tmp_path: Path) -> None:
    proxy = Nginx(tmp_path / "nginx", group.port, is_expired=True)
    try:
        with pytest.raises(subprocess.CalledProcessError) as refused:
            curl(proxy, "")
        assert "certificate has expired" in refused.value.stderr
        with pytest.raises(ssl.SSLCertVerificationError, match="certificate has expired"):
            connect(
                f"wss://127.0.0.1:{proxy.port}{PREFIX}p/ada/",
                ssl=ssl.create_default_context(cafile=proxy.certificate),
                proxy=None,
            )
    finally:
        proxy.end()


def test_half_requests_at_the_proxy_do_not_block_a_pupil(group: RunningClass, proxy: Nginx) -> None:
    context = ssl.create_default_context(cafile=proxy.certificate)
    slow = []
    for _ in range(50):
        plain = socket.create_connection(("127.0.0.1", proxy.port), timeout=PATIENCE_S)
        slow.append(context.wrap_socket(plain, server_hostname="127.0.0.1"))
        slow[-1].sendall(f"POST {PREFIX}p/ada/nodes HTTP/1.1\r\nHost: x\r\nContent-Length: 100\r\n\r\n[".encode())
    assert curl(proxy, "p/ada/nodes", *bearer(group.token_of("ada")))[0] == 200
    for one in slow:
        one.close()
