"""The index's texts: those of our files by themselves, made again when a file changes."""

from __future__ import annotations

import pytest

from thymio_sim_ros.files import resources
from thymio_sim_ros.files.playground_index import PlaygroundIndex
from thymio_sim_ros.sim.playground import reader as playgrounds
from thymio_sim_ros.sim.playground.reader import PlaygroundError

EMPTY = '{"format": 1, "title": "%s"}'


@pytest.mark.parametrize("name", list(resources.playgrounds()))
def test_every_shipped_playground_is_given_as_it_is(name):
    given = playgrounds.loads(PlaygroundIndex().text(name), f"{name}.json")
    shipped = playgrounds.load(resources.playgrounds()[name])
    assert (given.shapes, given.robots, given.title, given.translations) == (
        shipped.shapes,
        shipped.robots,
        shipped.title,
        shipped.translations,
    )


def test_what_is_not_shipped_is_none():
    assert PlaygroundIndex().text("../pyproject") is None


def test_a_file_that_changes_is_read_again(tmp_path, monkeypatch):
    path = tmp_path / "mine.json"
    monkeypatch.setattr(resources, "playgrounds", lambda: {"mine": path})
    index = PlaygroundIndex()
    path.write_text(EMPTY % "old")
    assert b"old" in index.text("mine")
    path.write_text(EMPTY % "new")
    assert b"new" in index.text("mine")
    path.unlink()
    with pytest.raises(PlaygroundError, match="readable"):
        index.text("mine")
