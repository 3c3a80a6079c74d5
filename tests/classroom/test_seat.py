"""The supervision of a pupil's suite, with a program in its place that notes how it ends."""

from __future__ import annotations

import asyncio
import contextlib
import os
from collections.abc import Mapping, Sequence
from multiprocessing.connection import Connection
from pathlib import Path

import pytest

from tests.bridge.peers import run
from tests.classroom.test_requests import OPTIONS
from tests.patience import PATIENCE_S
from thymio_sim_ros.classroom import seat as seats
from thymio_sim_ros.classroom import suite_process
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.folder import ClassFolder

pytestmark = pytest.mark.process


def note_how_it_ends(arguments: Sequence[str], _variables: Mapping[str, str], _log: Path, life: Connection) -> None:
    """In place of a suite: it notes that it runs, and that it is asked to end."""
    note = Path(arguments[0])
    note.write_text("started")
    with contextlib.suppress(EOFError):
        life.recv_bytes()
    note.write_text("ended")


@pytest.mark.parametrize("phase", ["starting", "running"])
def test_a_class_that_ends_lets_its_suites_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, phase: str) -> None:
    note = tmp_path / "note"
    monkeypatch.setattr(os, "cpu_count", lambda: 1)  # one suite starts at a time
    monkeypatch.setattr(suite_process, "_run", note_how_it_ends)
    monkeypatch.setattr(seats, "command", lambda *_: [str(note)])
    folder = ClassFolder(tmp_path / "class")
    (place,) = folder.places(["Ada"])

    async def scenario() -> None:
        classroom = Classroom([place], OPTIONS, folder)
        seat = classroom.seats[place.id]
        running = asyncio.create_task(classroom.run())
        async with asyncio.timeout(PATIENCE_S):
            while not (note.exists() and note.read_text() == "started"):
                await asyncio.sleep(0)
            if phase == "running":
                seat.phase = phase
                async with seat._starting:  # free again as soon as the suite counts as started
                    pass
            running.cancel()
            await asyncio.gather(running, return_exceptions=True)

    run(scenario())
    assert note.read_text() == "ended"
