"""The shipped missions and their index."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.missions.shipped import find_mission, index, shipped

FOLDER = Path(__file__).parents[2] / "playgrounds" / "missions"


def test_the_index_lists_each_mission_file_once_and_in_order() -> None:
    listed = [each.path for step in shipped() for each in step.missions]
    files = {path for path in FOLDER.glob("*/*.json") if not path.name.endswith(".playground.json")}
    assert len(listed) == len(set(listed))
    assert set(listed) == files
    assert [step.name for step in shipped()] == sorted(path.name for path in FOLDER.iterdir() if path.is_dir())


def test_the_index_for_pages_has_titles_stars_and_paths() -> None:
    first = index()["steps"][0]
    assert first["titles"]["de"] == "Losfahren"
    mission = first["missions"][0]
    assert (mission["name"], mission["titles"]["en"], mission["stars"]) == ("forward", "Off you go", 3)
    assert Path(mission["path"]).is_file()


def test_a_mission_is_found_by_name_or_path(tmp_path: Path) -> None:
    path = tmp_path / "own.json"
    path.write_text("{}")
    assert find_mission("forward") == FOLDER / "1-drive" / "forward.json"
    assert find_mission(str(path)) == path
    with pytest.raises(
        ResourceError, match=r"no mission 'forwards': neither a file nor one of .*; did you mean 'forward'"
    ):
        find_mission("forwards")
