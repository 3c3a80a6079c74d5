"""What a suite publishes as JSON, and what a pupil's node may publish instead."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.classroom.test_requests import OPTIONS
from thymio_sim_ros.classroom.bridge_client import BridgeClient
from thymio_sim_ros.classroom.folder import ClassFolder
from thymio_sim_ros.classroom.handouts import Handouts
from thymio_sim_ros.classroom.seat import Seat
from thymio_sim_ros.classroom.suite_state import SuiteState, SuiteStateError, read_overview, read_state

STATE = {"paused": True, "achieved": 0.98, "robots": [{"robot": "a", "fallen": True}, {"robot": "b", "fallen": False}]}
OVERVIEW = {"robots": {"a": [0.1, 0, 3.1, 0, 32, 0]}, "objects": {"box": [1, 2, 3], "ball": None}}


def test_the_state_and_the_overview_of_a_suite_are_read() -> None:
    assert read_state(json.dumps(STATE | {"seed": 4})) == SuiteState(True, 0.98, ("a",))
    assert read_overview(json.dumps(OVERVIEW)) == OVERVIEW


@pytest.mark.parametrize(
    "text",
    [
        "[]", "5", "null", "{}", "{", "[" * 3000, '{"paused": true, "achieved": NaN, "robots": []}',
        '{"paused": true, "achieved": 1e999, "robots": []}', '{"paused": 1, "achieved": 1, "robots": []}',
        '{"paused": true, "achieved": 1, "robots": [{}]}', '{"paused": true, "achieved": 1, "robots": {"a": 1}}',
    ],
)  # fmt: skip
def test_another_state_is_rejected(text: str) -> None:
    with pytest.raises(SuiteStateError):
        read_state(text)


@pytest.mark.parametrize(
    "changed", [{"robots": []}, {"objects": 3}, {"robots": {"a": [1]}}, {"objects": {"b": [1, 2, "3"]}}]
)
def test_another_overview_is_rejected(changed: dict[str, object]) -> None:
    with pytest.raises(SuiteStateError):
        read_overview(json.dumps(OVERVIEW | changed))


@pytest.mark.parametrize("text", ["[]", "[" * 3000, '{"achieved": NaN}', '{"robots": [3]}'])
def test_what_a_pupil_publishes_does_not_break_the_page_of_the_teacher(tmp_path: Path, text: str) -> None:
    folder = ClassFolder(tmp_path)
    (place,) = folder.places(["Ada"])
    seat = Seat(place, OPTIONS, folder, Handouts(folder.handouts))
    seat._client = client = BridgeClient("ws://localhost:1/", "token", seat._on_parameter, seat._on_try)
    for topic in ("/simulator/_state", "/simulator/_overview", "/simulator/_mission", "/simulator/_mission/try"):
        payload = text.encode() + b"\0"
        client._read(topic, b"\0\1\0\0" + len(payload).to_bytes(4, "little") + payload)
    summary = seat.summary()
    assert (summary["paused"], summary["achieved"], summary["overview"]) == (False, 0.0, {})
