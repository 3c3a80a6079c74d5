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
from thymio_sim_ros.cli.mission_assignment import mission_assignment, with_mission
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.grading.assignment import load
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


@pytest.mark.slow
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


@pytest.mark.slow
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


BUS = Path(__file__).parents[2] / "docs" / "course" / "3-blocks"


def lesson(folder: Path, text: str) -> Path:
    """The lesson with the bus in a folder, with this assignment."""
    for name in ("bus.json", "mission.json", "test_bus.py"):
        shutil.copy(BUS / name, folder)
    (folder / "assignment.toml").write_text(text, encoding="utf-8")
    return folder / "assignment.toml"


@pytest.mark.process
def test_an_assignment_has_points_for_tests_and_stars(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = lesson(
        tmp_path, 'tests = ["test_bus.py"]\nfiles = ["bus.aesl"]\ndata = ["bus.json"]\nmission = "mission.json"'
    )
    for name in ("start", "solution"):
        (tmp_path / "class" / name).mkdir(parents=True)
        shutil.copy(BUS / "programs" / f"{name}.aesl", tmp_path / "class" / name / "bus.aesl")
    arguments = ["--assignment", str(path), "-o", str(tmp_path / "grades"), "--workers", "1"]
    assert main(["grade", str(tmp_path / "class"), *arguments]) == 0
    assert "13 points" in capsys.readouterr().out
    assert marks(tmp_path / "grades")["solution"] == "13"
    assert int(marks(tmp_path / "grades")["start"]) <= 3
    program = str(BUS / "programs" / "solution.aesl")
    assert main(["mission", str(path), "--program", program]) == 0
    assert "★★★ passed" in capsys.readouterr().out


def test_an_assignment_may_be_a_mission_alone(tmp_path: Path) -> None:
    path = lesson(tmp_path, 'mission = "mission.json"\n[limits]\ncpu_s = 7')
    found = with_mission(load(path))
    assert (found.tests, found.expected, found.limits.cpu_s) == (("test_mission.py",), ("mission.aesl",), 7.0)
    assert set(found.content) == {"test_mission.py", "mission.json", "bus.json"}
    (tmp_path / "assignment.toml").write_text('mission = "mission.json"\nfiles = ["map.json", "my bus.aesl"]')
    found = with_mission(load(path))
    assert found.expected == ("map.json", "my bus.aesl")
    assert '"thymio": "my bus.aesl"' in found.content["test_mission.py"].decode()


def test_the_pictures_of_a_playground_are_in_the_assignment(tmp_path: Path) -> None:
    (tmp_path / "dot.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg" width="4" height="4"/>')
    picture = {"kind": "picture", "name": "dot", "size_x_m": 0.5, "size_y_m": 0.5, "image": "dot.svg"}
    hall = {"format": 1, "title": "Hall", "shapes": [picture], "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.0}]}
    (tmp_path / "hall.json").write_text(json.dumps(hall))
    facts = {"a": {"kind": "driven", "distance_m": 0.1}}
    mission = {"format": 1, "title": "A dot", "playground": "hall.json", "facts": facts, "success": "a"}
    (tmp_path / "dot.json").write_text(json.dumps(mission))
    content = mission_assignment(str(tmp_path / "dot.json")).content["hall.json"]
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "hall.json").write_bytes(content)
    assert (
        load_playground(str(tmp_path / "elsewhere" / "hall.json"))[1].shapes
        == load_playground(str(tmp_path / "hall.json"))[1].shapes
    )


@pytest.mark.parametrize(
    ("text", "error"),
    [
        ('mission = "../mission.json"', "mission: found '../mission.json', expected the relative path of a mission"),
        ("mission = 3", "mission: found 3, expected the relative path of a mission"),
        ('mission = "other.json"', "no mission|No such file"),
        (
            'mission = "mission.json"\nfiles = ["bus.py"]',
            "found the files bus.py, expected a program that ends in .aesl",
        ),
        (
            'mission = "mission.json"\ntests = ["test_mission.py"]',
            "found another file test_mission.py in the assignment",
        ),
    ],
)
def test_an_assignment_whose_mission_is_wrong_names_its_place(tmp_path: Path, text: str, error: str) -> None:
    (tmp_path / "test_mission.py").write_text("")
    path = lesson(tmp_path, text)
    with pytest.raises(GradingError, match=error):
        with_mission(load(path))


def test_an_assignment_without_a_mission_is_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = lesson(tmp_path, 'tests = ["test_bus.py"]\ndata = ["bus.json"]')
    assert main(["mission", str(path)]) == USAGE_ERROR
    assert "mission: found none, expected the file of a mission" in capsys.readouterr().err
