"""Page and bridge behind a reverse proxy: whose tries of tokens are counted, and which origins are the page's own."""

from __future__ import annotations

import contextlib
import http.client
from collections.abc import Iterator
from pathlib import Path

import pytest
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from tests.patience import PATIENCE_S
from tests.web.test_thread import Sink
from thymio_sim_ros.access import attempts
from thymio_sim_ros.access.visitor import TrustedProxies
from thymio_sim_ros.bridge import SUBPROTOCOLS, BridgeServer, ServerInfo, ServerSettings, Tokens
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard
from thymio_sim_ros.web import Content, ServerThread, Settings

pytestmark = pytest.mark.process

TOKEN = "lesson-2026"
"""Chosen, so that it may be guessed."""


@contextlib.contextmanager
def served(folder: Path, tokens: Tokens, *proxies: str) -> Iterator[int]:
    """The port of page and bridge behind these proxies."""
    (folder / "index.html").write_text("page")
    thread = ServerThread(warn=print)
    try:
        thread.trust(TrustedProxies(proxies))
        board = Switchboard(ServerInfo("test", ()))
        thread.mount_bridge(BridgeServer(board, Sink(), thread.loop, ServerSettings(tokens=tokens)))
        thread.mount_page(Content(folder, b"{}"), Settings(is_loopback=not proxies))
        yield thread.listen("127.0.0.1", 0)[1]
    finally:
        thread.close()


def status(port: int, token: str, headers: dict[str, str]) -> int:
    """The status of a handshake, 101 if the client is connected."""
    try:
        with connect(f"ws://127.0.0.1:{port}/?token={token}", subprotocols=SUBPROTOCOLS, additional_headers=headers):
            return 101
    except InvalidStatus as error:
        return error.response.status_code


@pytest.mark.parametrize(("proxies", "second_visitor"), [(("127.0.0.1",), 401), ((), 429)])
def test_tries_are_counted_by_visitor_and_a_claim_of_another_address_does_not_help(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, proxies: tuple[str, ...], second_visitor: int
) -> None:
    monkeypatch.setattr(attempts, "_PER_S", 1e-9)  # the time that passes gives no attempts back
    monkeypatch.setattr(attempts, "_MAX_WAIT_S", 0.0)
    with served(tmp_path, Tokens(TOKEN), *proxies) as port:
        first = {"X-Forwarded-For": "192.0.2.7"}
        assert {status(port, f"wrong{number}", first) for number in range(attempts._BURST)} == {401}
        assert status(port, "wrong", first) == 429
        assert status(port, "wrong", {"X-Forwarded-For": "192.0.2.8"}) == second_visitor
        assert status(port, "wrong", {"X-Forwarded-For": "192.0.2.7, 127.0.0.1"}) == 429


@pytest.mark.parametrize(("proxies", "found"), [(("127.0.0.1",), 101), ((), 403)])
def test_the_origin_of_a_page_is_compared_with_the_address_of_the_proxy(
    tmp_path: Path, proxies: tuple[str, ...], found: int
) -> None:
    with served(tmp_path, Tokens(), *proxies) as port:
        own = {"Origin": "https://10.1.2.3", "X-Forwarded-Host": "10.1.2.3", "X-Forwarded-Proto": "https"}
        assert status(port, "", own) == found
        assert status(port, "", {**own, "Origin": "https://10.1.2.4"}) == 403


@pytest.mark.parametrize(("proxies", "found"), [(("127.0.0.1",), 200), ((), 403)])
def test_a_page_on_loopback_has_the_name_of_its_proxy(tmp_path: Path, proxies: tuple[str, ...], found: int) -> None:
    with served(tmp_path, Tokens(TOKEN), *proxies) as port:
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=PATIENCE_S)
        connection.request("GET", "/", headers={"Host": "school.example"})
        assert connection.getresponse().status == found
        connection.close()
