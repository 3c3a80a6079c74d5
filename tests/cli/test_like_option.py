"""`thymio-sim --like`: what is refused before anything starts, and what a profile loads."""

from __future__ import annotations

import pytest

from thymio_sim_ros.cli import suite
from thymio_sim_ros.cli.main import main


@pytest.mark.parametrize(
    ("words", "reason"),
    [
        (["--like", "turtelsim"], "--like: found no robot 'turtelsim', expected 'turtlesim'"),
        (["--like", "turtlesim", "--like", "turtlesim"], "--like: found turtlesim and turtlesim, expected one robot"),
        (["--like", "turtlesim", "--robot", "tcp:localhost:33333"], "--robot: found --like"),
        (["--like", "turtlesim", "--replay", "run.jsonl"], "--replay: found --like"),
    ],
)
def test_what_cannot_be_is_one_line(capsys: pytest.CaptureFixture[str], words: list[str], reason: str) -> None:
    assert main(words) == 2
    said = capsys.readouterr().err
    assert said.startswith(f"thymio-sim: {reason}")
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("words", "playground", "program"),
    [
        ([], "desk", "welcome"),
        (["--like", "turtlesim"], "turtlesim", "none"),
        (["--like", "turtlebot3"], "turtlebot3", "none"),
        (["--like", "create3"], "turtlebot3", "none"),
        (["--like", "turtlesim", "--playground", "base", "--program", "avoid"], "base", "avoid"),
    ],
)
def test_a_profile_has_a_playground_and_a_program_of_its_own(words: list[str], playground: str, program: str) -> None:
    chosen = suite._suite_config(suite._parser().parse_args(words))
    assert (chosen.playground, chosen.program) == (playground, program)
