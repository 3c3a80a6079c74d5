"""The programs that the page offers to begin with: each compiles in each language and does what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from aseba_vm.languages import LANGUAGES, texts
from tests.tracks import assert_avoids
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.testing import Classroom, followed_line

FOLDER = Path(__file__).parents[2] / "web_ui" / "editor" / "skeletons"
NAMES = sorted(path.stem for path in FOLDER.glob("*.aseba"))


def skeleton(name: str, language: str = "en") -> str:
    """The text as the page shows it."""
    table = texts("editor", language)
    return re.sub(r"\{([\w.]+)\}", lambda found: table[found[1]], (FOLDER / f"{name}.aseba").read_text())


def test_there_are_the_three_of_the_page() -> None:
    assert NAMES == ["avoid", "button", "line"]


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", NAMES)
def test_a_skeleton_compiles_in_every_language(name: str, language: str) -> None:
    load_program(skeleton(name, language), name)


def test_a_button_starts_the_robot_and_another_stops_it() -> None:
    (thymio,) = Classroom("base", load_program(skeleton("button"), "button"))
    thymio.touch("forward")
    thymio.run(1.0)
    assert thymio["motor.left.target"] == thymio["motor.right.target"] == 200
    thymio.touch("center")
    thymio.run(1.0)
    assert thymio["motor.left.target"] == thymio["motor.right.target"] == 0


def test_the_line_is_followed() -> None:
    (thymio,) = Classroom("line", load_program(skeleton("line"), "line"))
    thymio.until(followed_line(thymio), 120.0)
    assert followed_line(thymio)


def test_things_are_avoided() -> None:
    assert_avoids(load_program(skeleton("avoid"), "avoid"))
