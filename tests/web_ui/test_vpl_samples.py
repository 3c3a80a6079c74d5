"""The programs of VPL that the page offers to begin with: each compiles and does what its title says."""

from __future__ import annotations

import json
import math
import subprocess
from pathlib import Path

import pytest

from tests.tracks import assert_avoids
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.testing import Classroom, followed_line, shows
from thymio_sim_ros.testing.thymio import Thymio
from web_ui import build

SCRIPT = Path(__file__).with_name("print_samples.js")
NAMES = ["empty", "avoid", "line", "buttons", "music", "timer", "states", "remote", "tilt", "counter"]
UP = 80
"""A command of the remote control."""

pytestmark = pytest.mark.process


@pytest.fixture(scope="module")
def samples() -> dict[str, ThymioProgram]:
    node = build.find_node()
    if node is None:
        pytest.skip("no Node on this machine")
    done = subprocess.run([node.folder / "node", SCRIPT], capture_output=True, text=True, check=True)
    return {name: load_program(text, name) for name, text in json.loads(done.stdout).items()}


def robot(program: ThymioProgram, playground: str = "base") -> Thymio:
    (thymio,) = Classroom(playground, program)
    thymio.run(0.5)
    return thymio


def test_each_sample_compiles(samples: dict[str, ThymioProgram]) -> None:
    assert list(samples) == NAMES


def test_things_are_avoided(samples: dict[str, ThymioProgram]) -> None:
    assert_avoids(samples["avoid"])


def test_the_line_is_followed(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["line"], "line")
    thymio.until(followed_line(thymio), seconds=240)


def test_buttons_and_the_remote_control_drive(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["buttons"])
    thymio.touch("forward")
    thymio.run(0.3)
    assert thymio["motor.left.target"] == 300
    assert shows(thymio, "top", [0, 32, 0])
    thymio = robot(samples["remote"])
    thymio.key(UP)
    thymio.run(0.3)
    assert thymio["motor.left.target"] == 300


def test_taps_and_claps_are_heard(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["music"])
    thymio.tap()
    thymio.run(0.3)
    assert shows(thymio, "top", [0, 0, 32])
    thymio.clap()
    thymio.run(0.3)
    assert shows(thymio, "bottom_left", [32, 0, 0])


def test_the_timer_changes_the_color(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["timer"])
    thymio.touch("center")
    thymio.run(0.5)
    assert shows(thymio, "top", [32, 32, 0])
    thymio.run(1.0)
    assert shows(thymio, "top", [32, 0, 0])
    thymio.run(2.0)
    assert shows(thymio, "top", [0, 32, 0])


def test_one_press_starts_and_the_next_one_stops(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["states"])
    for speed in (200, 0, 200):
        thymio.touch("center")
        thymio.run(0.5)
        assert thymio["motor.left.target"] == speed


def test_tilting_is_shown(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["tilt"])
    thymio.tilt(roll_rad=math.radians(45))
    thymio.run(0.5)
    assert shows(thymio, "top", [32, 0, 0]) or shows(thymio, "top", [0, 0, 32])


def test_three_presses_are_counted(samples: dict[str, ThymioProgram]) -> None:
    thymio = robot(samples["counter"])
    for _ in range(2):
        thymio.touch("center")
        thymio.run(0.2)
    thymio.touch("forward")
    thymio.run(0.2)
    assert thymio["motor.left.target"] == 0
    thymio.touch("center")
    thymio.run(0.2)
    thymio.touch("forward")
    thymio.run(0.2)
    assert thymio["motor.left.target"] == 200
