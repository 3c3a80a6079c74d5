"""The capacitive buttons as the firmware sees them."""

from __future__ import annotations

import pytest

from tests.sim.builders import FLOOR, make, readings, run, send
from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.sensors.button_counts import is_touched
from thymio_sim_ros.sim.world import World


def parts(words: tuple[int, ...]) -> tuple[tuple[int, ...], tuple[int, ...], tuple[int, ...]]:
    """Counts, means, noise."""
    return words[:5], words[5:10], words[10:]


@pytest.mark.parametrize("button", BUTTONS)
def test_the_rule_of_the_firmware_decides_which_button_is_touched(button: str) -> None:
    world = World(make([FLOOR]), seed=2)
    send(world, PressButton(button, pressed=True))
    held = readings(run(world, 0.01), "button_counts")[-1].words
    assert [is_touched(*each) for each in zip(*parts(held), strict=True)] == [name == button for name in BUTTONS]
    send(world, PressButton(button, pressed=False))
    released = readings(run(world, 0.03), "button_counts")[-1].words
    assert not any(is_touched(*each) for each in zip(*parts(released), strict=True))
    assert parts(held)[1:] == parts(released)[1:]


def test_buttons_differ_a_little_and_a_seed_repeats_them() -> None:
    one, again, other = (readings(run(World(make([FLOOR]), seed=seed), 0.1), "button_counts")[0] for seed in (1, 1, 2))
    assert one == again
    assert one != other
    assert len(set(one.words[5:10])) > 1
    assert all(1900 <= mean <= 2100 for mean in one.words[5:10])


@pytest.mark.parametrize(
    ("count", "noise", "touched"), [(849, 10, True), (850, 10, False), (779, 200, True), (780, 200, False)]
)
def test_a_count_must_fall_by_the_noise_and_a_margin(count: int, noise: int, touched: bool) -> None:
    assert is_touched(count, 1000, noise) == touched
