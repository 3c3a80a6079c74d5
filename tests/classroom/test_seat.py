"""The supervision of a pupil's suite, with a program in its place that notes how it ends."""

from __future__ import annotations

import asyncio
import os
import sys
from pathlib import Path

import pytest

from tests.bridge.peers import run
from tests.classroom.test_requests import OPTIONS
from tests.patience import PATIENCE_S
from thymio_sim_ros.classroom import seat as seats
from thymio_sim_ros.classroom.classroom import Classroom
from thymio_sim_ros.classroom.folder import ClassFolder

pytestmark = pytest.mark.process

SUITE = """
import pathlib, signal, sys
note = pathlib.Path(sys.argv[1])
def end(*_):
    note.write_text("ended")
    sys.exit(0)
signal.signal(signal.SIGINT, end)
note.write_text("started")
while True:
    signal.pause()
"""


@pytest.mark.parametrize("phase", ["starting", "running"])
def test_a_class_that_ends_lets_its_suites_end(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, phase: str) -> None:
    note = tmp_path / "note"
    monkeypatch.setattr(os, "cpu_count", lambda: 1)  # one suite starts at a time
    monkeypatch.setattr(seats, "command", lambda *_: [sys.executable, "-c", SUITE, str(note)])
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
