"""Names and numbers that come from elsewhere."""

from __future__ import annotations

import math

import pytest

from thymio_sim_ros.sim.playground.importers.names import Names, rounded, turned


@pytest.mark.parametrize(
    ("wanted", "name"),
    [
        ("Thymio II 0", "thymio_ii_0"),
        ("TLC1", "tlc1"),
        ("uShape", "u_shape"),
        ("Tür über", "tur_uber"),
        ("3rd", "thing_3rd"),
        ("///", "thing"),
        ("", "thing"),
        ("a" * 200, "a" * 50),
        ("a" * 49 + " b", "a" * 49),
    ],
)
def test_a_name_becomes_the_nearest_ros_name(wanted: str, name: str) -> None:
    assert Names().take(wanted, "thing") == name


def test_no_name_is_given_out_twice() -> None:
    names = Names()
    assert [names.take("Wall", "wall") for _ in range(3)] == ["wall", "wall_2", "wall_3"]


def test_numbers_lose_their_noise() -> None:
    assert rounded(5.000000000000001) == 5.0
    assert turned(2 * math.pi + 0.5) == 0.5
    assert turned(-0.0) == 0.0
