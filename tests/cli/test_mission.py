"""The command `thymio-sim mission`, and the missions of the course."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path

import pytest

from thymio_sim_ros.cli.main import main

COURSE = Path(__file__).parents[2] / "docs" / "course"


def judged(capsys: pytest.CaptureFixture[str], lesson: str, program: str, *options: str) -> tuple[int, str]:
    folder = COURSE / lesson
    code = main(["mission", str(folder / "mission.json"), "--program", str(folder / "programs" / program), *options])
    return code, capsys.readouterr().out


@pytest.mark.parametrize(("lesson", "stars"), [("1-buttons", 2), ("3-blocks", 3), ("4-text", 2)])
def test_the_solution_passes_and_the_start_does_not(
    capsys: pytest.CaptureFixture[str], lesson: str, stars: int
) -> None:
    code, output = judged(capsys, lesson, "solution.aesl", "--json")
    assert (code, json.loads(output)["stars"]) == (0, stars)
    code, output = judged(capsys, lesson, "start.aesl", "--json")
    assert (code, json.loads(output)["stars"]) == (1, 0)


def test_a_mistake_is_said_in_words_of_the_mission_with_a_hint(capsys: pytest.CaptureFixture[str]) -> None:
    code, output = judged(capsys, "1-buttons", "mistake.aesl")
    assert code == 1
    assert "[x] Its light is green while it drives forward" in output
    assert "☆☆ not passed: It touched something, after " in output
    assert "Hint: When the button forward" in output


def test_texts_are_in_the_language_of_the_pupil(capsys: pytest.CaptureFixture[str]) -> None:
    code, output = judged(capsys, "3-blocks", "solution.aesl", "--language", "de")
    assert code == 0
    assert output.splitlines()[:2] == ["Eine Runde mit dem Bus", "[x] Der Bus wartet auf den Knopf"]


@pytest.mark.parametrize(
    ("name", "text", "error"),
    [
        ("missing.json", None, "expected a mission file"),
        ("bad.json", '{"format": 1}', "bad.json: success: found nothing, expected a condition"),
    ],
)
def test_a_file_that_cannot_be_used_is_one_line(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, name: str, text: str | None, error: str
) -> None:
    path = tmp_path / name
    if text is not None:
        path.write_text(text)
    assert main(["mission", str(path)]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 1
    assert error in lines[0]


STILL = {"a": {"kind": "still", "text": "It stands"}}
WAITING = {"format": 1, "title": "Wait", "playground": "base", "facts": STILL, "success": {"hold": "a", "for_s": 1}}
DRIVE = "motor.left.target = 200\nmotor.right.target = 200\n"


def checked(capsys: pytest.CaptureFixture[str], folder: Path, **members: object) -> tuple[int, str]:
    """Check a mission in a folder."""
    (folder / "wait.json").write_text(json.dumps(WAITING | members), encoding="utf-8")
    code = main(["mission", str(folder / "wait.json"), "--check"])
    return code, capsys.readouterr().out


def test_a_solution_must_pass_and_a_start_must_not(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "drive.aesl").write_text(DRIVE)
    (tmp_path / "wait.aesl").write_text("var a\n")
    code, output = checked(capsys, tmp_path, solutions={"text": "wait.aesl"}, programs={"text": "drive.aesl"}, time_s=3)
    assert (code, output) == (0, "solutions.text: ★ passed after 1.01 s\nprograms.text: ☆ failed after 3.00 s\n")
    code, output = checked(capsys, tmp_path, solutions={"text": "drive.aesl"}, programs={"text": "wait.aesl"}, time_s=3)
    assert code == 1
    assert "solutions.text: found 0 of 1 stars, expected all of them" in output
    assert "programs.text: found a start that passes, expected something to do" in output


def untrusted(capsys: pytest.CaptureFixture[str], path: Path) -> tuple[int, str]:
    """Check the file of someone else."""
    code = main(["mission", str(path), "--check", "--untrusted"])
    said = capsys.readouterr()
    return code, said.out + said.err


def test_nodes_of_an_untrusted_mission_are_not_run(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path, trace = tmp_path / "wait.json", tmp_path / "has_run"
    (tmp_path / "node.py").write_text(f"open({str(trace)!r}, 'w')")
    path.write_text(json.dumps(WAITING | {"solutions": {"ros": "node.py"}}))
    assert untrusted(capsys, path) == (0, "solutions.ros: not run\n")
    assert not trace.exists()
    path.write_text(json.dumps(WAITING | {"solutions": {"ros": "node.py"}, "robot": "thymio9"}))
    assert untrusted(capsys, path)[0] == 2


def test_an_untrusted_mission_has_files_of_its_own_only(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    path = tmp_path / "wait.json"
    path.write_text(json.dumps(WAITING | {"playground": str(COURSE / "1-buttons" / "parking.json")}))
    code, said = untrusted(capsys, path)
    assert code == 2
    assert "playground: found " in said
    with zipfile.ZipFile(tmp_path / "wait.zip", "w") as archive:
        archive.writestr("mission.json", json.dumps(WAITING | {"playground": "room.json"}))
        archive.writestr("room.json", "{")
    code, said = untrusted(capsys, tmp_path / "wait.zip")
    assert code == 2
    assert said.startswith("thymio-sim: room.json: ")


def test_missions_that_lead_back_to_one_before_are_reported(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "more.json").write_text(json.dumps(WAITING | {"next": "wait.json"}), encoding="utf-8")
    code, output = checked(capsys, tmp_path, next="more.json")
    assert code == 1
    assert "next: found the circle wait.json → more.json → wait.json, expected a last mission" in output
    code, output = checked(capsys, tmp_path, next="wait.json")
    assert "next: found the circle wait.json → wait.json, expected a last mission" in output
    assert checked(capsys, tmp_path, next="forward")[0] == 0
