"""Files that commands get as options."""

from __future__ import annotations

from argparse import ArgumentTypeError
from pathlib import Path

import pytest

from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import check_files, describe_lidar, lidar_argument
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.sim.model.lidar import Lidar

ASEBA = """<aseba-playground><color name="w" r="1" g="1" b="1"/><world w="100" h="80" color="w"/>
{robot}</aseba-playground>"""


def test_a_program_needs_a_robot(tmp_path: Path) -> None:
    path = tmp_path / "old.playground"
    path.write_text(ASEBA.format(robot='<e-puck x="50" y="40"/>'), encoding="utf-8")
    with pytest.raises(UsageError) as caught:
        check_files(str(path), "explorer", "", THYMIO)
    assert str(caught.value).startswith(f"{path}: found no robot, expected one for explorer; line 2: <e-puck> skipped")


@pytest.mark.parametrize("program", ["none", "welcome"])
def test_a_world_without_robots_is_simulated_when_no_program_is_chosen(tmp_path: Path, program: str) -> None:
    path = tmp_path / "old.playground"
    path.write_text(ASEBA.format(robot=""), encoding="utf-8")
    assert check_files(str(path), program, "", THYMIO)[0].robots == ()


def test_a_robot_of_aseba_1_5_runs_the_program(tmp_path: Path) -> None:
    path = tmp_path / "old.playground"
    path.write_text(ASEBA.format(robot='<thymio2 x="50" y="40" port="33333" angle="1.57"/>'), encoding="utf-8")
    playground, assignments = check_files(str(path), "explorer", "", THYMIO)
    (robot,) = playground.robots
    assert (robot.x_m, robot.y_m, robot.yaw_rad) == (0.5, 0.4, pytest.approx(1.57))
    assert assignments[robot.name].program is not None


def test_a_lidar_is_described_by_the_text_that_makes_it() -> None:
    assert lidar_argument("beams=180, range=2,noise=0") == Lidar(180, 2.0, 10.0, 0.0)
    for lidar in (Lidar(), Lidar(7, 1.25, 5.0, 0.5)):
        assert lidar_argument(describe_lidar(lidar)) == lidar


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("beam=4", "'beam' is no option of a lidar, expected beams=…, range=…, rate=…, noise=…, each at most once"),
        ("beams=4,beams=5", "'beams' was given twice, expected"),
        ("", "'' is no option of a lidar"),
        ("beams=4.5", "beams: found '4.5', expected an integer"),
        ("range", "range: found '', expected a number"),
        ("range=nan", "lidar: range_m: found nan, expected a number from 0.1 to 10"),
        ("rate=1000", "lidar: rate_hz: found 1000, expected a number from 0.1 to 100"),
    ],
)
def test_a_lidar_that_cannot_be_is_refused(text: str, problem: str) -> None:
    with pytest.raises(ArgumentTypeError) as caught:
        lidar_argument(text)
    assert problem in str(caught.value)
