"""The one port of a class: which path leads where, and what reaches a suite, with a fake suite in place of Ada's."""

from __future__ import annotations

import asyncio
import json
import socket
import ssl
from collections.abc import Awaitable, Callable, Mapping
from pathlib import Path

import aiohttp
import pytest

from tests.bridge.certificates import make_certificate
from tests.bridge.peers import run
from tests.classroom.served_class import FakeSuite, ServedClass, fake_suite, served
from tests.patience import PATIENCE_S
from thymio_sim_ros.access import attempts
from thymio_sim_ros.bridge.tls import tls_context

pytestmark = pytest.mark.process

Scenario = Callable[[ServedClass, FakeSuite, aiohttp.ClientSession], Awaitable[None]]


def play(path: Path, scenario: Scenario, *proxies: str, has_tls: bool = False, has_room: bool = True) -> None:
    """Run a scenario with a class behind `proxies`, a suite of Ada, and a client."""
    path.mkdir(exist_ok=True)
    files = make_certificate(path) if has_tls else None
    tls = tls_context(*map(str, files)) if files else None
    trust = ssl.create_default_context(cafile=files[0]) if files else True

    async def main() -> None:
        timeout = aiohttp.ClientTimeout(total=PATIENCE_S)
        async with (
            asyncio.timeout(PATIENCE_S),
            served(path, proxies=proxies, tls=tls, has_room=has_room) as group,
            fake_suite(group) as suite,
            aiohttp.ClientSession(
                connector=aiohttp.TCPConnector(ssl=trust), timeout=timeout, auto_decompress=False
            ) as client,
        ):
            await scenario(group, suite, client)

    run(main())


def raw_status(port: int, target: str) -> tuple[int, str]:
    """Status and text of the answer to a target that clients would change."""
    with socket.create_connection(("127.0.0.1", port), timeout=PATIENCE_S) as connection:
        connection.sendall(f"GET {target} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n".encode())
        text = b"".join(iter(lambda: connection.recv(65536), b"")).decode()
    return int(text.split()[1]), text.partition("\r\n\r\n")[2]


def test_each_path_has_its_page_and_the_rest_of_a_pupil_is_the_suite(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        for path, text in {
            "": "join",
            "teacher/": "class",
            "p/ada/": "index",
            "p/ada/?tour=off": "index",
            "p/ada/assets/index-DGs6OHeF.js": "export {};",
            "p/ada/config.json": "GET /config.json ",
            "p/ada/nodes?token=x": "GET /nodes?token=x ",
        }.items():
            async with client.get(group.url(path)) as answer:
                assert (answer.status, await answer.text()) == (200, text), path
        async with client.post(group.url("p/ada/nodes/1"), data=b"[1]") as answer:
            assert await answer.text() == "POST /nodes/1 [1]"

    play(tmp_path, scenario)


def test_folders_without_a_slash_lead_to_themselves_behind_any_prefix(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        for path, place in {"teacher": "teacher/", "p/ada?token=abcd": "ada/?token=abcd"}.items():
            async with client.get(group.url(path), allow_redirects=False) as answer:
                assert (answer.status, answer.headers["Location"]) == (308, place)

    play(tmp_path, scenario)


@pytest.mark.parametrize(
    "target",
    [
        "/p/",
        "/p",
        "/p/mia/",
        "/p/Ada/nodes",
        "/p/../teacher/",
        "/p/ada/../ben/nodes",
        "/p/ada/%2e%2e/ben/nodes",
        "/p/%2e%2e/class.json",
        "/p/ada/..%2fben/nodes",
        "/p/ada/..%5cben/nodes",
        "/%70/ada/nodes",
        "//p/ada/nodes",
        "http://localhost/p/ada/nodes",
        "/room/other",
        "/teacher/nothing",
    ],
)
def test_a_path_that_leads_nowhere_is_not_found_and_reaches_no_suite(tmp_path: Path, target: str) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, _client: aiohttp.ClientSession) -> None:
        status, text = await asyncio.to_thread(raw_status, group.port, target)
        assert status == 404
        assert "ada" not in text
        assert suite.requests == []

    play(tmp_path, scenario)


async def forwarded(
    group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession, headers: Mapping[str, str]
) -> dict[str, str]:
    """What a suite gets of the headers of a request."""
    async with client.get(group.url("p/ada/nodes"), headers=headers) as answer:
        assert answer.status == 200
    return dict(suite.requests[-1].headers)


SPOOFED = {"X-Forwarded-For": "192.0.2.7", "X-Forwarded-Host": "school.example", "X-Forwarded-Prefix": "/lab"}


def test_a_suite_gets_the_address_of_the_visitor_not_a_claim(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        given = {**SPOOFED, "Cookie": "secret=1", "Forwarded": "for=192.0.2.7", "Authorization": "Bearer abcd"}
        headers = await forwarded(group, suite, client, given)
        assert headers["X-Forwarded-For"] == "127.0.0.1"
        assert headers["X-Forwarded-Host"] == f"localhost:{group.port}"
        assert headers["X-Forwarded-Prefix"] == ""
        assert headers["Authorization"] == "Bearer abcd"
        assert not {"Cookie", "Forwarded"} & set(headers)

    play(tmp_path, scenario)


def test_a_trusted_proxy_in_front_of_the_class_reports_the_visitor(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        headers = await forwarded(group, suite, client, SPOOFED | {"X-Forwarded-Proto": "https"})
        assert {name: headers[name] for name in SPOOFED} == SPOOFED
        assert headers["X-Forwarded-Proto"] == "https"
        async with client.post(group.url("p/ada/nodes/1"), data=b"[1]", headers=SPOOFED) as answer:
            assert await answer.text() == "POST /nodes/1 [1]"

    play(tmp_path, scenario, "127.0.0.1")


def test_a_name_of_another_computer_is_refused_unless_a_proxy_has_it(tmp_path: Path) -> None:
    def status(*proxies: str) -> int:
        found: list[int] = []

        async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
            async with client.get(group.url("p/ada/nodes"), headers={"Host": "school.example"}) as answer:
                found.append(answer.status)

        play(tmp_path / "-".join(("class", *proxies)), scenario, *proxies)
        return found[0]

    assert (status(), status("127.0.0.1")) == (403, 200)


def test_a_stream_arrives_as_it_is_sent(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        async with client.get(group.url("p/ada/events")) as answer:
            assert await answer.content.readline() == b"data: first\n"
            suite.go_on.set()
            assert (await answer.content.read()).endswith(b"data: last\n\n")

    play(tmp_path, scenario)


def test_a_suite_that_is_away_is_a_503_that_names_the_pupil(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        for path in ("p/ben/config.json", "p/ben/nodes"):
            async with client.get(group.url(path)) as answer:
                assert answer.status == 503
                assert answer.headers["Retry-After"] == "2"
                assert "The simulator of Ben does not answer." in await answer.text()
        async with client.get(group.url("p/ben/")) as answer:
            assert await answer.text() == "index"  # the page says so itself, and connects again
        with pytest.raises(aiohttp.WSServerHandshakeError, match="503"):
            await client.ws_connect(group.url("p/ben/"))

    play(tmp_path, scenario)


@pytest.mark.parametrize("has_tls", [False, True])
def test_a_websocket_carries_messages_of_all_sizes_in_both_directions(tmp_path: Path, has_tls: bool) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        address = group.url("p/ada/?token=right")
        async with client.ws_connect(address, protocols=("foxglove.sdk.v1",), max_msg_size=0, compress=15) as socket:
            assert socket.protocol == "foxglove.sdk.v1"
            assert await socket.receive_str() == "hello"
            for size in (0, 1, 125, 126, 65_536, 5_000_000):
                sent = bytes(range(256)) * (size // 256) + bytes(size % 256)
                await socket.send_bytes(sent)
                if size < 4 << 20:
                    assert await socket.receive_bytes() == sent
                else:  # longer than the suite accepts: its reason arrives
                    assert (await socket.receive()).data == aiohttp.WSCloseCode.MESSAGE_TOO_BIG
        await suite.left.wait()

    play(tmp_path, scenario, has_tls=has_tls)


def test_the_refusal_of_a_websocket_arrives_and_the_connection_can_be_used_on(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        upgrade = {"Connection": "Upgrade", "Upgrade": "websocket", "Sec-WebSocket-Version": "13"}
        async with client.get(group.url("p/ada/?token=wrong"), headers=upgrade) as answer:
            assert (answer.status, await answer.text()) == (401, "the token is wrong\n")
        async with client.get(group.url("p/ada/nodes")) as answer:
            assert answer.status == 200
        assert [request.path for request in suite.requests] == ["/", "/nodes"]

    play(tmp_path, scenario)


def test_a_page_that_does_not_read_stops_its_suite_and_no_other_page(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        address = group.url("p/ada/?token=right")
        reader, writer = await asyncio.open_connection("127.0.0.1", group.port)
        key = "dGhlIHNhbXBsZSBub25jZQ=="
        head = f"Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}"
        writer.write(f"GET /p/ada/?token=right HTTP/1.1\r\nHost: localhost\r\n{head}\r\n\r\n".encode())
        assert b"101" in await reader.readline()
        mask = bytes(4)
        writer.write(b"\x81\x85" + mask + b"flood")
        before = -1
        while suite.sent == 0 or suite.sent > before:  # until nothing more can be sent
            before = suite.sent
            async with client.ws_connect(address) as other:  # meanwhile another page is served
                assert await other.receive_str() == "hello"
                await other.send_bytes(b"still there")
                assert await other.receive_bytes() == b"still there"
        assert suite.sent < 64 << 20
        writer.transport.abort()
        await suite.left.wait()

    play(tmp_path, scenario)


def test_the_names_need_the_code_of_the_room(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(attempts, "_PER_S", 1e-9)  # the time that passes gives no attempts back
    monkeypatch.setattr(attempts, "_MAX_WAIT_S", 0.0)

    async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        async def ask(code: str, address: str) -> tuple[int, str]:
            headers = {"Authorization": f"Bearer {code}", "X-Forwarded-For": address}
            async with client.get(group.url("room/names"), headers=headers) as answer:
                return answer.status, await answer.text()

        code, ada = group.classroom.folder.room_code, group.classroom.seats["ada"].place
        status, text = await ask(code, "192.0.2.1")
        assert status == 200
        assert f'"name": "Ada", "link": "p/ada/#token={ada.token}"' in text
        assert {(await ask("wrong1", "192.0.2.7"))[0] for _ in range(attempts._BURST)} == {401}
        assert (await ask("wrong1", "192.0.2.7"))[0] == 429
        assert (await ask("wrong1", "192.0.2.8"))[0] == 401  # another visitor of the same proxy
        assert (await ask(code, "192.0.2.1"))[0] == 200

    play(tmp_path, scenario, "127.0.0.1")


def test_with_a_certificate_the_class_speaks_https_and_its_links_say_so(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        async with client.post(group.url("p/ada/nodes"), data=b"[1]") as answer:
            assert await answer.text() == "POST /nodes [1]"
        assert suite.requests[-1].headers["X-Forwarded-Proto"] == "https"
        headers = {"Authorization": f"Bearer {group.classroom.folder.teacher_token}"}
        async with client.get(group.url("teacher/class/room"), headers=headers) as answer:
            assert (await answer.json())["address"] == f"https://localhost:{group.port}/"
        with pytest.raises(aiohttp.ClientConnectionError):
            await client.get(group.url().replace("https", "http"))

    play(tmp_path, scenario, has_tls=True)


@pytest.mark.parametrize(("has_room", "status"), [(True, 200), (False, 404)])
def test_names_cannot_be_chosen_in_a_class_with_links_only(tmp_path: Path, has_room: bool, status: int) -> None:
    async def scenario(group: ServedClass, _suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        async with client.get(group.url("room")) as answer:
            assert json.loads(await answer.read()) == {"has_code": has_room}
        headers = {"Authorization": f"Bearer {group.classroom.folder.room_code}"}
        async with client.get(group.url("room/names"), headers=headers) as answer:
            assert answer.status == status

    play(tmp_path, scenario, has_room=has_room)


def test_a_hand_out_needs_the_token_of_its_pupil(tmp_path: Path) -> None:
    async def scenario(group: ServedClass, suite: FakeSuite, client: aiohttp.ClientSession) -> None:
        handout = group.classroom.handouts.add("program", "bus.aesl", b"onevent prox", ["ada"])
        place = group.url(f"p/ada/class/handouts/{handout.id}")
        ada, ben = (group.classroom.seats[pupil].place for pupil in ("ada", "ben"))
        for token, status in ((ada.token, 200), (ada.read_only_token, 401), (ben.token, 401), ("", 401)):
            async with client.get(place, headers={"Authorization": f"Bearer {token}"}) as answer:
                assert answer.status == status
        async with client.get(place, headers={"Authorization": f"Bearer {ada.token}"}) as answer:
            assert await answer.json() == {"kind": "program", "name": "bus.aesl", "content": "b25ldmVudCBwcm94"}
        for number in ("nothing", "..%2F..%2Fclass.json", ""):
            other = group.url(f"p/ada/class/handouts/{number}")
            async with client.get(other, headers={"Authorization": f"Bearer {ada.token}"}) as answer:
                assert answer.status == 404
        assert suite.requests == []

    play(tmp_path, scenario)
