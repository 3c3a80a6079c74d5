"""macOS and Windows without ROS, as far as Linux can show it: docs/platforms.md says what was not tried."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground, read_program

ROOT = Path(__file__).parent.parent
FOLDER = "Übung 1 für Zoë – gruß"
PROGRAM = "# Größe – 1 €\nvar n = 0\nonevent prox\nn += 1\nmotor.left.target = 100\nmotor.right.target = 100\n"
LEGACY = {
    "Windows, output in a legacy code page": {"PYTHONIOENCODING": "cp1252", "PYTHONUTF8": "0"},
    "no locale": {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"},
}


@pytest.fixture
def files(tmp_path: Path) -> Path:
    """A folder with an awkward name, a program and a playground; both have accents and line ends of Windows."""
    folder = tmp_path / FOLDER
    folder.mkdir()
    (folder / "grün.aesl").write_bytes(PROGRAM.replace("\n", "\r\n").encode())
    playground = json.loads((ROOT / "playgrounds" / "line.json").read_text("utf-8")) | {"title": "Größe"}
    (folder / "spaß.json").write_bytes(
        json.dumps(playground, indent=1, ensure_ascii=False).replace("\n", "\r\n").encode()
    )
    return folder


def run(folder: Path, commands: list[list[str]], **environment: str) -> tuple[dict[str, Any], str]:
    """Run commands on the other system; return what it reports, and all its output."""
    path = folder / "commands.json"
    path.write_text(json.dumps(commands), encoding="utf-8")
    command = [sys.executable, "-X", "warn_default_encoding", "-m", "tests.other_system", str(path)]
    given = os.environ | {"PYTHONPATH": str(ROOT)} | environment
    done = subprocess.run(command, cwd=folder, env=given, capture_output=True, check=False)
    output = (done.stdout + done.stderr).decode("utf-8", "replace")
    assert done.returncode == 0, output
    report: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return report, output


@pytest.mark.process
@pytest.mark.parametrize("environment", LEGACY.values(), ids=LEGACY)
def test_commands_without_ros_run_without_posix_and_in_a_legacy_encoding(
    files: Path, environment: dict[str, str]
) -> None:
    world = ["--playground", "spaß.json", "--program", "grün.aesl"]
    commands = [
        ["aseba", "check", "grün.aesl"],
        ["aseba", "fmt", "grün.aesl"],
        ["thymio-sim", "runner", *world, "--seconds", "1", "--log", "lauf für.jsonl"],
        ["thymio-sim", "replay", "lauf für.jsonl"],
        ["thymio-sim", "convert", "spaß.json", "-o", "nächste.json"],
        ["thymio-sim", "foxglove-layout", "-o", "schön.json"],
        ["thymio-sim", "--version"],
    ]
    report, output = run(files, commands, **environment)
    assert [code or 0 for code in report["codes"]] == [0, 0, 0, 0, 0, 0, 0], output
    converted = json.loads((files / "nächste.json").read_text("utf-8"))
    assert converted["title"] == "Größe"
    of_ros = {name for name in report["modules"] if name.startswith("thymio_sim_ros.ros.")}
    assert all(name.startswith("thymio_sim_ros.ros.profiles") for name in of_ros)  # rows that need no ROS


@pytest.mark.process
def test_an_error_is_a_line_that_a_legacy_code_page_can_show(files: Path) -> None:
    (files / "falsch.aesl").write_text("motor.links = “1”\n", encoding="utf-8")
    commands = [["aseba", "check", "falsch.aesl"], ["thymio-sim", "runner", "--program", "fehlt für.aesl"]]
    report, output = run(files, commands, **LEGACY["no locale"])
    assert report["codes"] == [1, 2]
    assert "Traceback" not in output


def test_line_ends_of_windows_change_nothing(files: Path) -> None:
    (files / "lf.aesl").write_bytes(PROGRAM.encode())
    (files / "lf.json").write_bytes((files / "spaß.json").read_bytes().replace(b"\r\n", b"\n"))
    poses = []
    for program, playground in (("grün.aesl", "spaß.json"), ("lf.aesl", "lf.json")):
        engine = Engine(load_playground(str(files / playground))[1], read_program(str(files / program)))
        begin = engine.world.robots["thymio"].pose
        engine.run(1.0)
        poses.append(engine.world.robots["thymio"].pose)
    assert poses[0] == poses[1]
    assert poses[0].x_m > begin.x_m + 0.02


def test_a_backslash_in_a_name_is_no_separator_of_this_system(files: Path) -> None:
    path = files / "folder\\grün.aesl"
    path.write_bytes(PROGRAM.encode())
    assert read_program(str(path)).name == path.name
