"""What a test names: names, paths beside the test, texts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.programs.program_assignment import RobotId
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.testing.sources import (
    beside,
    is_name,
    playground_of,
    playground_source,
    program_source,
    programs_of,
)


def _program_of(value: Any, folder: Path | None = None) -> ThymioProgram:
    return programs_of(value, {"thymio": RobotId("", 1)}, folder)["thymio"]


def test_a_file_in_the_folder_is_found_and_anything_else_stays(tmp_path: Path) -> None:
    (tmp_path / "mine.aesl").write_text("var a")
    assert beside("mine.aesl", tmp_path) == str(tmp_path / "mine.aesl")
    assert beside(Path("mine.aesl"), tmp_path) == str(tmp_path / "mine.aesl")
    assert beside("line", tmp_path) == "line"
    assert beside("mine.aesl", None) == "mine.aesl"
    long_text = '{"title": "' + "x" * 5000 + '"}'
    assert beside(long_text, tmp_path) == long_text


def test_no_file_beside_the_test_replaces_what_is_shipped(tmp_path: Path) -> None:
    for name in ("line", "explorer", "none"):
        (tmp_path / name).write_text("")
    assert playground_source("line", tmp_path) == "line"
    assert program_source("explorer", tmp_path) == "explorer"
    assert program_source("none", tmp_path) == "none"
    assert playground_source(Path("line"), tmp_path) == str(tmp_path / "line")
    assert playground_of("line", tmp_path) == playground_of("line")
    assert _program_of("explorer", tmp_path).name == "explorer.aesl"


def test_a_program_is_a_name_a_path_or_a_text(tmp_path: Path) -> None:
    path = tmp_path / "my robot.aesl"
    path.write_text("var a")
    assert is_name("explorer")
    assert is_name(str(path))
    assert not is_name("var a")
    assert not is_name("")
    assert _program_of("explorer").name == "explorer.aesl"
    assert _program_of("my robot.aesl", tmp_path).name == "my robot.aesl"
    assert _program_of("var a = 1").source == "var a = 1"
    loaded = _program_of("var a")
    assert _program_of(loaded) is loaded


def test_a_path_that_is_no_file_is_no_text() -> None:
    with pytest.raises(ResourceError, match="no program 'var a'"):
        _program_of(Path("var a"))
    with pytest.raises(ResourceError, match=r"no program 'students/Anna Smith/follower\.aesl': neither a file nor"):
        _program_of("students/Anna Smith/follower.aesl")


def test_a_playground_may_be_loaded_already() -> None:
    _, loaded = load_playground("line")
    assert playground_of(loaded) is loaded
    assert playground_of("line") == loaded
