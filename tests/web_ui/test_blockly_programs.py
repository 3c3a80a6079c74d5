"""The golden programs of blocks, as the page generates them: they compile, and the robot does what the blocks say."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from tests.tracks import farthest_in_laps
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.sim.playground import reader as playgrounds

FOLDER = Path(__file__).parents[1] / "data" / "web" / "blockly"
PROGRAMS = sorted(path.stem for path in FOLDER.glob("*.aseba"))

ROOM = {
    "format": 1,
    "title": "Room",
    "shapes": [{"kind": "rectangle", "size_x_m": 3.0, "size_y_m": 3.0, "color": "#ffffff", "walls": {}}],
    "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0, "yaw_rad": 0.0}],
}


def runner_of(name: str, playground: str = "") -> Engine:
    world = load_playground(playground)[1] if playground else playgrounds.loads(json.dumps(ROOM), "room")
    program = load_program((FOLDER / f"{name}.aseba").read_text(encoding="utf-8"), name)
    return Engine(world, program, noise=False)


@pytest.mark.parametrize("name", PROGRAMS)
def test_a_program_of_blocks_compiles(name: str) -> None:
    assert load_program((FOLDER / f"{name}.aseba").read_text(encoding="utf-8"), name).program.words


def test_the_obstacle_program_drives_and_does_not_push_against_obstacles() -> None:
    engine = runner_of("avoid_obstacles", "obstacle")
    robot = engine.world.robots["thymio"]
    places = []
    for _ in range(60):
        engine.run(0.5)
        places.append((robot.pose.x_m, robot.pose.y_m))
    assert len({(round(x, 1), round(y, 1)) for x, y in places}) > 8
    for start in range(0, 60, 20):
        xs, ys = zip(*places[start : start + 20], strict=True)
        assert math.hypot(max(xs) - min(xs), max(ys) - min(ys)) > 0.05


def test_the_line_program_follows_the_line() -> None:
    assert farthest_in_laps(runner_of("follow_line", "line"), 1) < 0.04


def run_script(name: str) -> tuple[Engine, list[int]]:
    """Run a script to its end; return the runner and the odometer: direction in degrees, x and y in mm."""
    engine = runner_of(name)
    variables = engine.devices["thymio"].variables
    assert engine.until(lambda: variables.get("done") == (1,), seconds=60)
    return engine, [variables.get(f"at_{part}")[0] for part in ("direction", "x", "y")]


def test_a_square_of_moves_and_turns_ends_where_it_began() -> None:
    engine, (direction, x_mm, y_mm) = run_script("scratch_square")
    pose = engine.world.robots["thymio"].pose
    assert math.hypot(pose.x_m, pose.y_m) < 0.01
    assert math.degrees(math.remainder(pose.yaw_rad, math.tau)) == pytest.approx(0, abs=3)
    assert direction == pytest.approx(0, abs=8)
    assert (x_mm, y_mm) == pytest.approx((0, 0), abs=25)


def test_an_arc_goes_clockwise_and_the_odometer_follows() -> None:
    engine, (direction, x_mm, y_mm) = run_script("scratch_arc")
    pose = engine.world.robots["thymio"].pose
    # a quarter of a circle of 150 mm, then 50 mm back: the robot looks to the right, which is down in the world
    assert (pose.x_m, pose.y_m) == pytest.approx((0.15, -0.10), abs=0.02)
    assert math.degrees(pose.yaw_rad) == pytest.approx(-90, abs=8)
    # the same in Scratch, where direction 90 is along x and angles are clockwise
    assert math.remainder(direction - 180, 360) == pytest.approx(0, abs=8)
    assert (x_mm, y_mm) == pytest.approx((150, -100), abs=20)


def test_each_color_light_has_a_place_on_the_color_wheel() -> None:
    engine = runner_of("scratch_colors")
    engine.run(0.5)
    variables = engine.devices["thymio"].variables
    # 0 is red, 33 yellow, 99 cyan: the left light went from 66 to 99, the right one from 0 to 33
    assert variables.get("leds.top") == (32, 0, 0)
    assert variables.get("leds.bottom.left") == (0, 32, 32)
    assert variables.get("leds.bottom.right") == (32, 32, 0)
