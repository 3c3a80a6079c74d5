"""The command thymio-sim foxglove-layout."""

from __future__ import annotations

import json

import pytest

from thymio_sim_ros.cli import foxglove_layout, main
from thymio_sim_ros.studio_layout import SHIPPED, render


def test_a_layout_is_printed(capsys):
    assert main.main(["foxglove-layout"]) == 0
    assert capsys.readouterr().out == render("foxglove")


def test_a_layout_of_one_of_several_robots_is_written(tmp_path, capsys):
    file = tmp_path / "layout.json"
    assert main.main(["foxglove-layout", "--robot", "/anna", "--app", "lichtblick", "-o", str(file)]) == 0
    assert json.loads(file.read_text()) == json.loads(render("lichtblick", "anna"))
    assert capsys.readouterr().out == ""


def test_a_file_that_cannot_be_written_is_one_line(tmp_path, capsys):
    assert main.main(["foxglove-layout", "-o", str(tmp_path / "no" / "where.json")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "where.json: No such file or directory; expected a file that can be written" in line


@pytest.mark.parametrize("name", ["a b", "1st", "a//b", "ä"])
def test_what_is_no_namespace_is_refused(name, capsys):
    with pytest.raises(SystemExit, match="2"):
        main.main(["foxglove-layout", "--robot", name])
    assert "expected a namespace" in capsys.readouterr().err


def test_the_hint_names_the_shipped_file_or_the_command():
    assert str(SHIPPED["foxglove"]) in foxglove_layout.hint(["thymio"])
    assert "--robot thymio_1 " in foxglove_layout.hint(["thymio_1", "thymio_2"])
