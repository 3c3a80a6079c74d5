"""The folder of a class."""

from __future__ import annotations

import json
import stat
from pathlib import Path

import pytest

from thymio_sim_ros.classroom.errors import ClassError
from thymio_sim_ros.classroom.folder import ClassFolder, Work


def test_links_and_programs_stay_when_the_list_of_names_changes(tmp_path: Path) -> None:
    first = ClassFolder(tmp_path / "class")
    ada, ben = first.places(["Ada", "Ben"])
    work = Work("var a = 1\n", "Adas Kreis.aesl", "var a = 2\r\n", '{"format": 1}', "desk")
    first.keep(ada, work)
    later = ClassFolder(tmp_path / "class")
    zoe, again = later.places(["Zoë", "Ada"])
    assert again == ada
    assert later.work(again) == work
    assert zoe.number not in (ada.number, ben.number)
    assert later.work(zoe) == Work()
    assert later.teacher_token == first.teacher_token


def test_tokens_differ_and_can_be_read_by_the_owner_only(tmp_path: Path) -> None:
    folder = ClassFolder(tmp_path / "class")
    places = folder.places(["Ada", "Ben"])
    tokens = [folder.teacher_token, *(token for place in places for token in (place.token, place.read_only_token))]
    assert len(set(tokens)) == 5
    assert all(token not in repr(places) for token in tokens)
    assert stat.S_IMODE((tmp_path / "class").stat().st_mode) == 0o700
    assert stat.S_IMODE((tmp_path / "class" / "class.json").stat().st_mode) == 0o600


@pytest.mark.parametrize(
    "text",
    ["{", "[]", '{"pupils": [{"id": "../x", "name": "x", "number": 0}]}', '{"pupils": [3]}', '{"teacher_token": "?"}'],
)
def test_a_damaged_file_is_refused_with_its_path(tmp_path: Path, text: str) -> None:
    (tmp_path / "class.json").write_text(text)
    with pytest.raises(ClassError, match=r"class\.json: .*restore or delete it"):
        ClassFolder(tmp_path)


def test_places_are_kept_as_json(tmp_path: Path) -> None:
    ClassFolder(tmp_path).places(["Jürg"])
    assert json.loads((tmp_path / "class.json").read_text())["pupils"][0]["id"] == "jurg"


@pytest.mark.parametrize("text", ["{", "[]", '{"playground": 3}', "null"])
def test_a_damaged_file_of_a_pupil_leaves_the_program(tmp_path: Path, text: str) -> None:
    folder = ClassFolder(tmp_path)
    [ada] = folder.places(["Ada"])
    folder.keep(ada, Work("var a = 1\n", playground="line"))
    (folder.pupil(ada) / "work.json").write_text(text)
    assert folder.work(ada) == Work("var a = 1\n")
