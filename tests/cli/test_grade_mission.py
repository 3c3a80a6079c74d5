"""Missions as assignments of `thymio-sim grade`."""

from __future__ import annotations

import csv
import json
import shutil
import sys
import zipfile
from pathlib import Path

import pytest

from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.cli.mission_assignment import mission_assignment
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.grading.errors import GradingError
from thymio_sim_ros.missions.shipped import shipped
from thymio_sim_ros.missions.trial import judged_run, robot_of
from thymio_sim_ros.testing import Classroom, judged

MISSIONS = {each.name: each for step in shipped() for each in step.missions}
FOLDER = Path(__file__).parents[2] / "playgrounds" / "missions"
OF_ASEBA = [name for name, each in MISSIONS.items() if each.mission.languages != ("ros",)]


def marks(folder: Path) -> dict[str, str]:
    with (folder / "marks.csv").open(encoding="utf-8") as file:
        return {row["name"]: row["points"] for row in csv.DictReader(file)}


@pytest.mark.process
def test_a_class_gets_a_point_for_each_star(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    programs = FOLDER / "5-robots"
    dark = (programs / "relay.solution.text.aesl").read_text(encoding="utf-8").replace("(0,32,0)", "(0,0,0)")
    for name, text in (
        ("Anna", (programs / "relay.solution.blocks.aesl").read_text(encoding="utf-8")),
        ("Bea", (programs / "relay.start.text.aesl").read_text(encoding="utf-8")),
        ("Carl", dark),
    ):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "my program.aesl").write_text(text, encoding="utf-8")
    grades = tmp_path / "grades"
    assert main(["grade", str(tmp_path / "class"), "--assignment", "relay", "-o", str(grades), "--workers", "1"]) == 0
    assert marks(grades) == {"Anna": "3", "Bea": "0", "Carl": "2"}
    assert "solution: 3 of 3 points" in capsys.readouterr().out
    (page,) = grades.glob("pupils/Bea-*/index.html")
    assert "bert waits" in page.read_text(encoding="utf-8") or "anna sends 5" in page.read_text(encoding="utf-8")


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="programs under test need Linux or macOS")
def test_a_node_is_graded_by_a_mission(tmp_path: Path) -> None:
    for name, program in (("Anna", "solution"), ("Bea", "start")):
        (tmp_path / "class" / name).mkdir(parents=True)
        source = FOLDER / "5-robots" / f"first_node.{program}.ros.py"
        shutil.copy(source, tmp_path / "class" / name / "first_node.py")
    arguments = ["--assignment", "first_node", "-o", str(tmp_path / "grades"), "--workers", "1"]
    assert main(["grade", str(tmp_path / "class"), *arguments]) == 0
    assert marks(tmp_path / "grades") == {"Anna": "3", "Bea": "0"}


@pytest.mark.parametrize("name", OF_ASEBA)
def test_the_stars_of_a_test_are_those_of_the_command(name: str) -> None:
    path, mission = MISSIONS[name].path, MISSIONS[name].mission
    program = mission.solutions[mission.languages[-1]]
    robot = robot_of(mission, load_playground(mission.playground)[1])
    classroom = Classroom(mission.playground, {robot: program, **mission.robots})
    assert judged(classroom[robot], path) == judged_run(mission, program).verdict


def test_an_assignment_has_what_a_run_needs_and_no_solution() -> None:
    found = mission_assignment("relay")
    assert found.expected == ("relay.aesl",)
    assert set(found.content) == {"test_mission.py", "relay.json", "relay.playground.json", "relay.bert.aesl"}
    assert found.solution == FOLDER / "5-robots" / "relay.solution.blocks.aesl"
    assert mission_assignment("first_node").expected == ("first_node.py",)


def test_a_mission_of_a_teacher_may_be_a_zip_and_use_a_shipped_playground(tmp_path: Path) -> None:
    path = tmp_path / "round.zip"
    facts = {"lap": {"kind": "lap"}}
    mission = {"format": 1, "title": "A round", "playground": "line", "facts": facts, "success": "lap"}
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("mission.json", json.dumps(mission))
    found = mission_assignment(str(path))
    assert found.expected == ("round.aesl",)
    assert 'playground="line"' in found.content["test_mission.py"].decode()


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('{"format": 1}', "success: found nothing, expected a condition"),
        (
            '{"format": 1, "title": "x", "playground": "lines", "facts": {"a": {"kind": "still"}}, "success": "a"}',
            "lines",
        ),
    ],
)
def test_a_mission_that_is_wrong_names_its_place(tmp_path: Path, text: str, error: str) -> None:
    path = tmp_path / "own.json"
    path.write_text(text)
    with pytest.raises(GradingError, match=error):
        mission_assignment(str(path))


def test_an_unknown_mission_is_one_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["grade", str(tmp_path), "--assignment", "brakes"]) == USAGE_ERROR
    assert "no mission 'brakes': neither a file nor one of forward, brake" in capsys.readouterr().err
