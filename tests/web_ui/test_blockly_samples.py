"""The samples of blocks, as the page generates them: they compile, and the robot does what their titles say."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from tests.tracks import assert_avoids
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.testing import Classroom, followed_line

FOLDER = Path(__file__).parents[1] / "data" / "web" / "blockly_samples"
SAMPLES = sorted(path.stem for path in FOLDER.glob("*.aseba"))


def sample(name: str):
    return load_program((FOLDER / f"{name}.aseba").read_text(encoding="utf-8"), name)


@pytest.mark.parametrize("name", SAMPLES)
def test_a_sample_compiles(name: str) -> None:
    assert sample(name).program is not None


@pytest.mark.parametrize("name", ["line", "scratch_line"])
def test_the_line_is_followed(name: str) -> None:
    (thymio,) = Classroom("line", sample(name))
    thymio.until(followed_line(thymio), 120.0)
    assert followed_line(thymio)


@pytest.mark.parametrize("name", ["avoid", "scratch_avoid"])
def test_things_are_avoided(name: str) -> None:
    assert_avoids(sample(name))


def test_a_script_drives_a_square() -> None:
    (thymio,) = Classroom("base", sample("scratch_motion"))
    start = thymio.pose
    thymio.run(2.0)
    assert math.hypot(thymio.pose.x_m - start.x_m, thymio.pose.y_m - start.y_m) > 0.1
    thymio.run(20.0)
    assert math.hypot(thymio.pose.x_m - start.x_m, thymio.pose.y_m - start.y_m) < 0.02
