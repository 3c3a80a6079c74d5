"""The command `thymio-sim replay`: reports, exit codes, rejected input."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import thymio_sim_ros
from thymio_sim_ros.cli import main
from thymio_sim_ros.cli.errors import USAGE_ERROR
from thymio_sim_ros.cli.replay import DIFFERENT


def test_the_commands_write_and_replay_a_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.jsonl"
    assert main.main(["runner", "--playground", "line", "--seconds", "3", "--log", str(path)]) == 0
    capsys.readouterr()
    assert main.main(["replay", str(path)]) == 0
    report = json.loads(capsys.readouterr().out)
    assert (report["runs"], report["seconds"], report["identical"]) == (1, 3.0, True)


def test_the_command_reports_what_differs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "run.jsonl"
    main.main(["runner", "--playground", "line", "--seconds", "3", "--log", str(path)])
    path.write_text(path.read_text().replace('"seed": 0', '"seed": 1'))
    capsys.readouterr()
    assert main.main(["replay", str(path)]) == DIFFERENT
    captured = capsys.readouterr()
    assert captured.err.endswith("run 1, tick 100 differs from the log\n")
    assert json.loads(captured.out)["identical"] is False


def test_the_command_reports_that_another_version_wrote_the_log(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "run.jsonl"
    main.main(["runner", "--playground", "line", "--seconds", "1", "--log", str(path)])
    made_by = f'"made_by": "{thymio_sim_ros.__version__}"'
    path.write_text(path.read_text().replace('"seed": 0', '"seed": 1').replace(made_by, '"made_by": "0.0.1"'))
    main.main(["replay", str(path)])
    assert f"(log written by version 0.0.1, this is {thymio_sim_ros.__version__})" in capsys.readouterr().err


@pytest.mark.parametrize("content", [None, "nonsense\n"], ids=["missing", "damaged"])
def test_the_command_refuses_a_bad_file_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], content: str | None
) -> None:
    path = tmp_path / "run.jsonl"
    if content is not None:
        path.write_text(content)
    assert main.main(["replay", str(path)]) == USAGE_ERROR
    assert capsys.readouterr().err.count("\n") == 1


def test_a_log_that_cannot_be_written_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "nowhere" / "run.jsonl"
    assert main.main(["runner", "--seconds", "1", "--log", str(path)]) == USAGE_ERROR
    assert "No such file or directory; expected a file that can be written" in capsys.readouterr().err
