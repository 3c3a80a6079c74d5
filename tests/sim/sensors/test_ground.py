"""Ground sensors: order, faces, floor, noise."""

from __future__ import annotations

import statistics

import pytest

from tests.sim import fake_view
from tests.sim.builders import FLOOR, ROBOT, make, measure_one
from tests.sim.fake_view import FakeView, Measurement
from thymio_sim_ros.sim.commands import SetAmbientLight
from thymio_sim_ros.sim.ground.sampling import GroundSample
from thymio_sim_ros.sim.model.noise import Noise
from thymio_sim_ros.sim.model.readings import GroundReading
from thymio_sim_ros.sim.sensors.ground import SENSOR
from thymio_sim_ros.sim.stimuli.environment import EnvironmentState
from thymio_sim_ros.sim.world import World

WHITE, BLACK = GroundSample(1.0, 1.0), GroundSample(0.0, 1.0)


def measure(left: GroundSample, right: GroundSample, noise: Noise | None = None, light: int = 0) -> GroundReading:
    view = FakeView(grounds={0.0115: left, -0.0115: right}, states=(EnvironmentState(ambient_light=light),))
    if noise is not None:
        view.noise = noise
    reading = fake_view.measure(SENSOR, view)
    assert isinstance(reading, GroundReading)
    return reading


def test_words_are_ambient_reflected_and_delta_left_then_right() -> None:
    assert measure(WHITE, BLACK).words == (0, 0, 938, 77, 938, 77)


@pytest.mark.parametrize(
    ("light", "words"),
    [(50, (50, 50, 988, 127, 938, 77)), (500, (500, 500, 1023, 577, 523, 77)), (1023, (1023,) * 4 + (0, 0))],
)
def test_ambient_light_is_added_to_what_is_reflected_up_to_the_limit(light: int, words: tuple[int, ...]) -> None:
    assert measure(WHITE, BLACK, light=light).words == words


@pytest.mark.parametrize("robots", [1, 14])
def test_an_operator_lights_the_ground_of_one_robot(robots: int) -> None:
    starts = [{**ROBOT, "name": f"robot{index}", "y_m": 0.13 * index} for index in range(robots)]
    world = World(make([FLOOR], starts), noise=False)
    world.post("robot0", SetAmbientLight(20))
    assert measure_one(world, "ground", "robot0").words == (20, 20, 958, 958, 938, 938)
    for index in range(1, robots):
        assert measure_one(world, "ground", f"robot{index}").words == (0, 0, 938, 938, 938, 938)


def test_reflectances_are_greys() -> None:
    assert measure(WHITE, BLACK).reflectances == (1.0, 0.0)


def test_without_floor_a_sensor_reads_nothing_in_spite_of_noise() -> None:
    reading = measure(GroundSample(0.0, 0.0), WHITE, Noise(1, "thymio", "ground"))
    assert reading.words[2] == 0
    assert reading.words[3] > 800


def test_noise_spreads_counts_as_measured() -> None:
    noise = Noise(1, "thymio", "ground")
    view = FakeView(grounds={0.0115: GroundSample(0.44, 1.0), -0.0115: WHITE}, noise=noise)
    measurement = Measurement(SENSOR, view)
    counts = [measurement.next().words[2] for _ in range(2000)]
    assert statistics.mean(counts) == pytest.approx(502, abs=1)
    assert statistics.stdev(counts) == pytest.approx(10, rel=0.1)


def test_a_robot_at_the_edge_of_a_table_reads_zero() -> None:
    world = World(make([{**FLOOR, "size_x_m": 0.1}]), noise=False)
    assert measure_one(world, "ground").words == (0,) * 6


def test_a_robot_astride_an_edge_of_colors_reads_both() -> None:
    halves = [
        {**FLOOR, "y_m": 2.0, "name": "north"},
        {**FLOOR, "y_m": -2.0, "name": "south", "color": "#000000"},
    ]
    world = World(make(halves, [ROBOT]), noise=False)
    assert measure_one(world, "ground").words[4:] == pytest.approx((938, 77), abs=3)
