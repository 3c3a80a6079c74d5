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
from thymio_sim_ros.classroom.suite_state import (
    MissionTry,
    SuiteState,
    SuiteStateError,
    read_overview,
    read_state,
    read_try,
)

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


TRY = {
    "mission": "bay",
    "tries": 2,
    "state": "failed",
    "done": [True, False],
    "stars": [False],
    "at_s": 3.5,
    "trouble": "",
    "file": "",
}


def test_a_try_of_a_mission_is_read_and_many_in_vain_are_said(tmp_path: Path) -> None:
    assert read_try(json.dumps(TRY)) == MissionTry("bay", 2, False, 0, 3.5, "", done=1, is_over=True)
    for changed in ({"done": 3}, {"tries": True}, {"at_s": "1"}, {"stars": None}):
        with pytest.raises(SuiteStateError):
            read_try(json.dumps(TRY | changed))
    seat = seat_of(tmp_path)
    for tries, trouble in ((2, ""), (6, "tries")):
        seat._client._read("/simulator/_mission/try", message(json.dumps(TRY | {"tries": tries, "done": []})))
        assert seat.summary()["trouble"] == trouble
    seat._client._read("/simulator/_mission/try", message(json.dumps(TRY | {"tries": 7, "trouble": "fallen"})))
    assert seat.summary()["trouble"] == "fallen"


def seat_of(folder: Path) -> Seat:
    """The seat of a pupil with a client that is not connected."""
    class_folder = ClassFolder(folder)
    (place,) = class_folder.places(["Ada"])
    seat = Seat(place, OPTIONS, class_folder, Handouts(class_folder.handouts))
    seat._client = BridgeClient("ws://localhost:1/", "token", seat._on_parameter, seat._on_try)
    return seat


def message(text: str) -> bytes:
    """A String message in CDR."""
    payload = text.encode() + b"\0"
    return b"\0\1\0\0" + len(payload).to_bytes(4, "little") + payload


@pytest.mark.parametrize("text", ["[]", "[" * 3000, '{"achieved": NaN}', '{"robots": [3]}'])
def test_what_a_pupil_publishes_does_not_break_the_page_of_the_teacher(tmp_path: Path, text: str) -> None:
    seat = seat_of(tmp_path)
    for topic in ("/simulator/_state", "/simulator/_overview", "/simulator/_mission", "/simulator/_mission/try"):
        seat._client._read(topic, message(text))
    summary = seat.summary()
    assert (summary["paused"], summary["achieved"], summary["overview"]) == (False, 0.0, {})
