"""A mission in a zip, and the limits of its files."""

from __future__ import annotations

import contextlib
import io
import json
import tempfile
import zipfile
from pathlib import Path

import pytest

from thymio_sim_ros.missions import MissionError, load_mission
from thymio_sim_ros.missions.description import described
from thymio_sim_ros.missions.trial import judged_run
from thymio_sim_ros.sim.model.fields import FieldError

PLAYGROUND = {
    "format": 1,
    "title": "Hall",
    "shapes": [{"kind": "rectangle", "name": "floor", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
    "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}],
}
MISSION = {
    "format": 1,
    "title": "A mission",
    "playground": "hall.json",
    "picture": "pictures/hall.png",
    "programs": {"text": "start.aesl"},
    "facts": {"a": {"kind": "driven", "distance_m": 0.1}},
    "success": "a",
}
DRIVE = "motor.left.target = 300\nmotor.right.target = 300\n"
FILES = {"hall.json": json.dumps(PLAYGROUND).encode(), "pictures/hall.png": b"png", "start.aesl": DRIVE.encode()}


def packed(folder: Path, files: dict[str, bytes], **members: object) -> Path:
    """A zip with these files and the mission."""
    path = folder / "mission.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, data in files.items():
            archive.writestr(name, data)
        archive.writestr("mission.json", json.dumps(MISSION | members))
    return path


def test_a_zip_has_all_that_a_mission_needs(tmp_path: Path) -> None:
    mission = load_mission(packed(tmp_path, FILES))
    assert Path(mission.picture).read_bytes() == b"png"
    assert judged_run(mission, mission.programs["text"]).verdict.is_passed


def test_a_zip_may_have_its_files_in_a_folder(tmp_path: Path) -> None:
    path = tmp_path / "mission.zip"
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in (FILES | {"hall.mission.json": json.dumps(MISSION).encode()}).items():
            archive.writestr(f"my hall/{name}", data)
    assert Path(load_mission(path).playground).is_file()


@pytest.mark.parametrize(
    ("files", "members", "error"),
    [
        (
            {"a.png": b"\0" * 20_000_000},
            {},
            r"found 20.0 MB in the zip, 20.0 MB of it in 'a.png', expected at most 10 MB",
        ),
        (
            {"a.png": b"\0" * 2_000_000},
            {"picture": "a.png"},
            "picture: found 2000000 bytes in 'a.png', expected at most",
        ),
        ({"../a.aesl": b""}, {}, r"found the name '../a.aesl' in the zip, expected names inside"),
        ({"/etc/a.aesl": b""}, {}, r"found the name '/etc/a.aesl' in the zip"),
        ({}, {"programs": {"text": "../../a.aesl"}}, "programs.text: found '../../a.aesl', expected a file of the zip"),
        ({}, {"playground": "/etc/hall.json"}, "playground: found '/etc/hall.json', expected a file of the zip"),
        ({"b/mission.json": b"{}"}, {}, "found 2 missions in the zip"),
        (dict.fromkeys(map(str, range(300)), b""), {}, "found 301 files in the zip, expected at most 200"),
    ],
)
def test_a_zip_that_is_too_large_or_leads_elsewhere_is_refused(
    tmp_path: Path, files: dict[str, bytes], members: dict[str, object], error: str
) -> None:
    with pytest.raises(MissionError, match=error):
        load_mission(packed(tmp_path, files, **members))


def test_a_zip_of_a_client_leaves_nothing_behind(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    elsewhere, folder = tmp_path / "elsewhere", tmp_path / "folder"
    for made in (elsewhere, folder):
        made.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(elsewhere))
    mission = load_mission(packed(tmp_path, FILES), folder=folder)
    assert Path(mission.playground).is_relative_to(folder)
    assert list(elsewhere.iterdir()) == []


def test_a_zip_that_was_cut_or_has_no_mission_is_refused(tmp_path: Path) -> None:
    path = packed(tmp_path, FILES)
    path.write_bytes(path.read_bytes()[:-40])
    with pytest.raises(MissionError, match="a damaged zip, expected a complete zip"):
        load_mission(path)
    empty = io.BytesIO()
    with zipfile.ZipFile(empty, "w") as archive:
        archive.writestr("hall.json", FILES["hall.json"])
    path.write_bytes(empty.getvalue())
    with pytest.raises(MissionError, match="found 0 missions in the zip"):
        load_mission(path)


@pytest.mark.parametrize(
    ("members", "error"),
    [
        ({"playground": "/etc/hosts"}, "playground: found '/etc/hosts', expected a file of the zip, or a shipped name"),
        ({"playground": "../hall"}, "playground: found '../hall', expected a file of the zip, or a shipped name"),
        ({"robots": {"anna": "/etc/hosts"}}, "robots.anna: found '/etc/hosts', expected a file of the zip"),
        ({"robots": {"anna": "~/secret"}}, "robots.anna: found '~/secret', expected a file of the zip"),
        ({"next": "/etc/hosts"}, "next: found '/etc/hosts', expected a file of the zip"),
    ],
)
def test_a_zip_names_no_other_file_of_the_computer(tmp_path: Path, members: dict[str, object], error: str) -> None:
    with pytest.raises(MissionError, match=error):
        load_mission(packed(tmp_path, FILES, **members))


def test_a_zip_with_changed_bytes_is_refused_or_read_and_nothing_else(tmp_path: Path) -> None:
    path = packed(tmp_path, FILES)
    data = path.read_bytes()
    for at in range(4, len(data), 3):
        path.write_bytes(data[:at] + bytes([data[at] ^ 0xFF]) + data[at + 1 :])
        with contextlib.suppress(MissionError):
            load_mission(path)


@pytest.mark.parametrize("name", ["a" * 300, "start.aesl/inner.aesl"])
def test_a_name_that_no_file_can_have_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(MissionError, match="in the zip, expected one that a file can have"):
        load_mission(packed(tmp_path, FILES | {name: b""}))


@pytest.mark.parametrize(
    ("programs", "error"),
    [
        ({"text": "gone.aesl"}, "programs.text: found no file 'gone.aesl', expected a program beside the mission"),
        ({"text": "pictures/raw.aesl"}, "programs.text: found an invalid byte in 'raw.aesl', expected UTF-8 text"),
        ({"text": "pictures/long.aesl"}, "programs.text: found 2000000 bytes in 'long.aesl', expected at most 1000000"),
    ],
)
def test_a_program_that_pages_cannot_have_names_its_place(tmp_path: Path, programs: dict[str, str], error: str) -> None:
    files = FILES | {"pictures/raw.aesl": b"\xff", "pictures/long.aesl": b"#" * 2_000_000}
    with pytest.raises(FieldError, match=error):
        described(load_mission(packed(tmp_path, files, programs=programs)))
