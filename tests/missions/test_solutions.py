"""Each shipped mission can be solved in each of its languages, and not without a pupil's work."""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
from PIL import Image

from aseba_vm.languages import LANGUAGES
from tests.patience import PROGRAM_S
from thymio_sim_ros.device.programs.program import parse
from thymio_sim_ros.files.loading import NO_PROGRAM
from thymio_sim_ros.missions.shipped import shipped
from thymio_sim_ros.missions.trial import judged_run

MISSIONS = {each.name: each for step in shipped() for each in step.missions}
ORDER = list(MISSIONS)
NUMBER, STARS = 20, 3
LARGEST_PICTURE = 10_000
NODE = "ros"
SOLUTIONS = [(name, language) for name, each in MISSIONS.items() for language in each.mission.languages]
STARTS = [(name, language) for name, each in MISSIONS.items() for language in each.mission.programs]
OF_ASEBA = [pair for pair in SOLUTIONS if pair[1] != NODE]
PLUGINS = {"vpl": "ThymioVisualProgramming", "blocks": "ThymioBlockly", "scratch": "ThymioBlockly"}


def test_no_mission_is_forgotten() -> None:
    assert len(MISSIONS) == NUMBER
    assert all(set(each.mission.solutions) == set(each.mission.languages) for each in MISSIONS.values())
    assert {name: 1 + len(each.mission.stars) for name, each in MISSIONS.items()} == dict.fromkeys(MISSIONS, STARS)


def test_no_mission_has_two_stars_for_its_time() -> None:
    timed = [sum(star.within_s is not None for star in each.mission.stars) for each in MISSIONS.values()]
    assert max(timed) == 1


@pytest.mark.parametrize(("name", "language"), OF_ASEBA)
def test_the_solution_gets_all_stars(name: str, language: str) -> None:
    mission = MISSIONS[name].mission
    verdict = judged_run(mission, mission.solutions[language]).verdict
    assert all(verdict.stars), verdict


@pytest.mark.parametrize("name", [name for name in MISSIONS if MISSIONS[name].mission.languages != (NODE,)])
def test_nothing_is_no_solution(name: str) -> None:
    assert not judged_run(MISSIONS[name].mission, NO_PROGRAM).verdict.is_passed


@pytest.mark.parametrize(("name", "language"), [pair for pair in STARTS if pair[1] != NODE])
def test_the_start_program_does_not_pass(name: str, language: str) -> None:
    mission = MISSIONS[name].mission
    assert not judged_run(mission, mission.programs[language]).verdict.is_passed


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="programs under test need Linux or macOS")
@pytest.mark.parametrize("name", [name for name, language in SOLUTIONS if language == NODE])
def test_a_node_gets_all_stars_and_the_start_does_not(name: str) -> None:
    mission = MISSIONS[name].mission
    solved, started = (_judged(name, program) for program in (mission.solutions[NODE], mission.programs[NODE]))
    assert solved.returncode == 0, solved.stderr
    assert json.loads(solved.stdout)["stars"] == 1 + len(mission.stars)
    assert started.returncode == 1, started.stderr


def _judged(name: str, program: str) -> subprocess.CompletedProcess[str]:
    """The command in a process of its own, which has imported no other ROS."""
    command = [sys.executable, "-m", "thymio_sim_ros", "mission", name, "--program", program, "--json"]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=PROGRAM_S)


@pytest.mark.parametrize(("name", "language"), OF_ASEBA)
def test_a_program_is_opened_in_the_editor_of_its_language(name: str, language: str) -> None:
    mission = MISSIONS[name].mission
    for path in filter(None, (mission.solutions[language], mission.programs.get(language))):
        plugins = [plugin.name for plugin in parse(Path(path).read_text(encoding="utf-8")).nodes[0].plugins]
        assert plugins == ([PLUGINS[language]] if language in PLUGINS else [])


@pytest.mark.parametrize("name", MISSIONS)
def test_all_texts_are_there_in_the_languages_of_the_page(name: str) -> None:
    mission = MISSIONS[name].mission
    assert set(mission.translations) == set(LANGUAGES) - {"en"}
    for texts in mission.translations.values():
        assert texts.title
        assert texts.story
        assert texts.facts.keys() == mission.facts.keys()
        assert texts.missing.keys() == {fact for fact, each in mission.facts.items() if each.missing}
        assert len(texts.hints) == len(mission.hints) >= 2
        assert len(texts.stars) == len(mission.stars)


@pytest.mark.parametrize("name", MISSIONS)
def test_the_next_mission_is_that_of_the_list(name: str) -> None:
    following = ORDER[ORDER.index(name) + 1 :][:1]
    expected = MISSIONS[following[0]].path if following else None
    found = MISSIONS[name].mission.next
    assert (Path(found).resolve() if found else None) == expected


@pytest.mark.parametrize("name", MISSIONS)
def test_it_has_a_small_picture(name: str) -> None:
    path = Path(MISSIONS[name].mission.picture)
    with Image.open(path) as picture:
        assert picture.size == (240, 160)
    assert path.stat().st_size < LARGEST_PICTURE


@pytest.mark.parametrize("name", MISSIONS)
def test_the_file_fits_the_schema(name: str) -> None:
    schema = json.loads((MISSIONS[name].path.parents[1] / "mission.schema.json").read_text(encoding="utf-8"))
    jsonschema.validate(json.loads(MISSIONS[name].path.read_text(encoding="utf-8")), schema)


def test_the_course_lists_all_missions_in_order() -> None:
    overview = (Path(__file__).parents[2] / "docs" / "course" / "README.md").read_text(encoding="utf-8")
    listed = re.findall(r"^\| \d .*\]\(.*?\) \(`(\w+)`\) \| .* \| ([a-z, ]+) \|$", overview, re.MULTILINE)
    assert listed == [(name, ", ".join(each.mission.languages)) for name, each in MISSIONS.items()]
