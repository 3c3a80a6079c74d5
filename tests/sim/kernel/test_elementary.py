"""Elementary functions against those of the math module."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest

from thymio_sim_ros.sim.kernel import elementary

CASES = [
    (elementary.sin, math.sin, 2.0, [-1e6, 1e6]),
    (elementary.cos, math.cos, 2.0, [-1e6, 1e6]),
    (elementary.sin, math.sin, 1.0, [-4.0, 4.0]),
    (elementary.cos, math.cos, 1.0, [-4.0, 4.0]),
    (elementary.exp, math.exp, 2.0, [-700.0, 700.0]),
    (elementary.log, math.log, 2.0, [1e-12, 1.0]),
    (elementary.log, math.log, 2.0, [0.5, 3.0]),
]


@pytest.mark.parametrize(("function", "expected", "units", "limits"), CASES)
def test_functions_are_exact_to_the_last_places(
    function: Callable[[float], float], expected: Callable[[float], float], units: float, limits: list[float]
) -> None:
    dice = random.Random(1)
    for _ in range(5000):
        x = dice.uniform(*limits)
        # Near a zero of the sine the error is that of the reduced argument, some 1e-17.
        assert abs(function(x) - expected(x)) <= units * math.ulp(expected(x)) + 1e-17, x


@pytest.mark.parametrize(
    ("function", "x", "expected"),
    [
        (elementary.sin, 0.0, 0.0),
        (elementary.cos, 0.0, 1.0),
        (elementary.exp, 0.0, 1.0),
        (elementary.log, 1.0, 0.0),
        (elementary.exp, 1e9, math.exp(700.0)),
        (elementary.exp, -1e9, math.exp(-700.0)),
    ],
)
def test_special_values(function: Callable[[float], float], x: float, expected: float) -> None:
    assert function(x) == pytest.approx(expected, rel=1e-15)
