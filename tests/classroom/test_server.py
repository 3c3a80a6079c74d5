"""The server of the teacher's page: who gets no answer, and what the log says then."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from pathlib import Path

import pytest

from tests.bridge.peers import run
from tests.classroom.served_class import served
from tests.patience import PATIENCE_S
from thymio_sim_ros.access import attempts
from thymio_sim_ros.bridge.connections import MIN_WAIT_S, Phase
from thymio_sim_ros.classroom import server
from thymio_sim_ros.classroom.requests import MAX_BODY

pytestmark = pytest.mark.process

TOKEN = "lesson-2026"
"""Of the teacher; chosen, so that it may be guessed."""


async def ask(port: int, name: str, token: str, body: bytes = b"") -> tuple[int, str]:
    """Status and text of the answer to a request."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    with contextlib.closing(writer):
        head = f"Host: localhost\r\nAuthorization: Bearer {token}\r\nContent-Length: {len(body)}\r\nConnection: close"
        writer.write(f"POST /{name} HTTP/1.1\r\n{head}\r\n\r\n".encode() + body)
        async with asyncio.timeout(PATIENCE_S):
            status, _, text = (await reader.read()).decode().partition("\r\n\r\n")
    return int(status.split()[1]), text


def test_who_tries_many_tokens_is_told_to_wait(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(attempts, "_PER_S", 1e-9)  # the time that passes gives no attempts back
    monkeypatch.setattr(attempts, "_MAX_WAIT_S", 0.0)

    async def answers() -> list[tuple[int, str]]:
        async with served(tmp_path, teacher_token=TOKEN) as group:
            found = [
                await ask(group.port, "teacher/class/message", f"wrong{number}")
                for number in range(attempts._BURST + 1)
            ]
            assert (await ask(group.port, "", ""))[0] == 405  # the page itself needs no token
            return found

    *refused, (status, text) = run(answers())
    assert {status for status, _ in refused} == {401}
    assert (status, text) == (429, "too many wrong tokens from this address; try again in a minute\n")


def test_a_body_that_is_too_large_is_answered(tmp_path: Path) -> None:
    async def answer() -> tuple[int, str]:
        async with served(tmp_path, teacher_token=TOKEN) as group:
            return await ask(group.port, "teacher/class/message", TOKEN, b" " * (20 << 20))

    assert run(answer()) == (413, f"expected a body of at most {MAX_BODY} bytes\n")


def test_connections_beyond_the_limit_are_logged_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(server, "max_connections", lambda: 6)  # two open files for each
    monkeypatch.setitem(MIN_WAIT_S, Phase.SILENT, 0.0)

    async def many() -> None:
        async with served(tmp_path, teacher_token=TOKEN) as group, contextlib.AsyncExitStack() as stack:
            for _ in range(30):
                _, writer = await asyncio.open_connection("127.0.0.1", group.port)
                stack.callback(writer.close)
            assert (await ask(group.port, "teacher/class/message", TOKEN, b'{"text": ""}'))[0] == 200

    with caplog.at_level(logging.WARNING):
        run(many())
    assert [record.getMessage() for record in caplog.records] == [
        "class: the maximum number of connections is reached; more have to wait"
    ]
