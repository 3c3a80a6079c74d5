"""Files that commands get as options."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.cli.errors import UsageError
from thymio_sim_ros.cli.options import check_files
from thymio_sim_ros.device.layout import THYMIO

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
