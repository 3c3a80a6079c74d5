"""Playgrounds seen from above, and the CDR of the topics that a class reads."""

from __future__ import annotations

import json
import struct

import pytest

from thymio_sim_ros.classroom.cdr import CdrError, read_diagnostic, read_string
from thymio_sim_ros.classroom.plan import plan_of
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground


@pytest.mark.parametrize("name", resources.playgrounds())
def test_every_playground_has_a_small_plan(name: str) -> None:
    plan = plan_of(load_playground(name)[1])
    left, bottom, right, top = plan["bounds"]
    assert left < right
    assert bottom < top
    assert len(json.dumps(plan)) < 100_000


def test_objects_are_marked_as_moving() -> None:
    solids = plan_of(load_playground("desk")[1])["solids"]
    assert any(not solid["moves"] for solid in solids)
    assert all(("points" in solid) != ("radius" in solid) for solid in solids)


def _text(value: str) -> bytes:
    data = value.encode() + b"\0"
    return struct.pack("<I", len(data)) + data + b"\0" * (-len(data) % 4)


HEAD = b"\x00\x01\x00\x00"


def test_strings_and_diagnostics_are_read() -> None:
    assert read_string(HEAD + _text("Zoë")) == "Zoë"
    pairs = _text("state") + _text("running") + _text("line") + _text("")
    status = HEAD + b"\x02\0\0\0" + _text("name") + _text("") + _text("node 1") + struct.pack("<I", 2) + pairs
    assert read_diagnostic(status) == {"state": "running", "line": ""}


@pytest.mark.parametrize("payload", [b"", b"\x00\x00\x00\x00", HEAD, HEAD + b"\xff\0\0\0abc", HEAD + b"\0\0\0\0"])
def test_other_bytes_are_refused(payload: bytes) -> None:
    with pytest.raises(CdrError):
        read_string(payload)
    with pytest.raises(CdrError):
        read_diagnostic(payload)
