"""Temperature as it is read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.commands import SetTemperature
from thymio_sim_ros.sim.world import World


def test_it_is_22_degrees_once_a_second_at_first() -> None:
    found = readings(run(World(make([FLOOR])), 10.0), "temperature")
    assert [(reading.words, reading.celsius) for reading in found] == [((220,), 22.0)] * 10


@pytest.mark.parametrize(("celsius", "word"), [(-40.0, -400), (-0.06, -1), (18.44, 184), (85.0, 850)])
def test_the_operator_sets_it(celsius: float, word: int) -> None:
    world = World(make([FLOOR]))
    run(world, 0.5)
    send(world, SetTemperature(celsius))
    (reading,) = readings(run(world, 1.0), "temperature")
    assert reading.words == (word,)
