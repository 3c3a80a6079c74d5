"""The battery as it is read."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.commands import ConnectCharger, SetBattery
from thymio_sim_ros.sim.world import World


def test_it_has_four_volts_at_first() -> None:
    (reading,) = readings(run(World(make([FLOOR])), 1.0), "battery")
    assert (reading.words, reading.volts, reading.is_charging) == ((796, 796, 0), 4.0, False)
    assert sum(reading.words[:2]) * 1000 // 3978 == 400


@pytest.mark.parametrize(
    ("volts", "word", "charge"), [(0.0, 0, 0.0), (3.4, 676, 0.0), (3.75, 746, 0.5), (4.1, 815, 1.0), (5.0, 994, 1.0)]
)
def test_the_operator_sets_it_at_once(volts: float, word: int, charge: float) -> None:
    world = World(make([FLOOR]))
    run(world, 0.5)
    send(world, SetBattery(volts))
    (reading,) = readings(run(world, 0.01), "battery")
    assert (reading.words, reading.volts) == ((word, word, 0), volts)
    assert reading.charge == pytest.approx(charge)


def test_a_charger_can_be_connected() -> None:
    world = World(make([FLOOR]))
    run(world, 0.5)
    send(world, ConnectCharger(True))
    (reading,) = readings(run(world, 0.01), "battery")
    assert (reading.words[2], reading.is_charging) == (1, True)
