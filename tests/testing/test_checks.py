"""Checks: true, false, and what they say; they combine, and they can be waited for."""

from __future__ import annotations

import math

import pytest

from tests.testing.test_thymio import WALL
from thymio_sim_ros.testing import Check, Classroom, Thymio, emitted, no_contact, reached, shows, slower_than

DRIVE = "motor.left.target = 200\nmotor.right.target = 200\n"
EVENTS = '<network><event size="1" name="moved"/><node name="thymio-II">{}</node></network>'


def alone(program: str = "none", playground: str = "base", seconds: float = 1.0) -> Thymio:
    (thymio,) = Classroom(playground, program, noise=False)
    thymio.run(seconds)
    return thymio


def test_reached_holds_within_its_tolerance_only() -> None:
    thymio = alone()
    thymio.place(0.3, 0.4)
    thymio.run(0.01)
    assert reached(thymio, (0.3, 0.4))
    assert reached(thymio, (0.3, 0.4, 0.0))
    assert reached(thymio, thymio.pose, 0.0)
    assert not reached(thymio, (0.0, 0.0), 0.499)
    assert repr(reached(thymio, (0, 0))) == (
        "thymio is at (0.300, 0.400), 0.500 m from (0, 0): expected at most 0.05 m"
    )
    assert not reached(thymio, (0.0, 0.0, 0.0))
    turned = reached(thymio, (0.3, 0.4, math.pi / 2))
    assert not turned
    assert "turned 90° away from 90°: expected at most 0.05 m and 15°" in repr(turned)


def test_headings_are_compared_round_the_circle() -> None:
    thymio = alone()
    thymio.place(0.0, 0.0, math.pi - 0.05)
    thymio.run(0.01)
    assert reached(thymio, (0.0, 0.0, -math.pi + 0.05), yaw_tolerance=0.11)


def test_no_contact_names_what_was_touched() -> None:
    thymio = alone(DRIVE, WALL, 6.0)
    assert not no_contact(thymio)
    touch = thymio.touches[0]
    assert repr(no_contact(thymio)) == f"thymio touched wall at {touch.at_s:.2f} s: expected no contact"
    assert no_contact(thymio, since=touch.at_s + 0.01)
    assert not no_contact(thymio, since=touch.at_s)
    assert repr(no_contact(alone())) == "thymio touched nothing"


def test_emitted_counts_events() -> None:
    thymio = alone(EVENTS.format("emit moved [4]\nemit moved [5]"), seconds=0.0)
    assert emitted(thymio, "moved")
    assert emitted(thymio, "moved", times=2)
    assert emitted(thymio, "moved", [5], times=1)
    assert not emitted(thymio, "moved", [6])
    assert not emitted(thymio, "moved", since=0.5)
    assert repr(emitted(thymio, "stop")) == (
        "thymio emitted stop 0 times; last of 2 events: moved [4] at 0.00 s, moved [5] at 0.00 s:"
        " expected at least once"
    )


def test_shows_takes_levels_and_names_of_colours() -> None:
    thymio = alone("call leds.top(32, 0, 0)\ncall leds.circle(1, 2, 3, 4, 5, 6, 7, 8)", seconds=0.1)
    assert shows(thymio, "top", "red")
    assert shows(thymio, "top", (30, 1, 0))
    assert not shows(thymio, "top", (30, 1, 0), tolerance=1)
    assert not shows(thymio, "top", "yellow")
    assert shows(thymio, "circle", range(1, 9), tolerance=0)
    assert repr(shows(thymio, "top", "off")) == "thymio shows (32, 0, 0) on top: expected (0, 0, 0) within 4"


@pytest.mark.parametrize(
    ("group", "levels", "text"),
    [
        ("top", "pink", "no color 'pink': expected one of off, red"),
        ("circle", "red", "circle: 3 levels found, expected 8"),
        ("roof", (1, 2, 3), "no lights 'roof': expected one of top"),
    ],
)
def test_lights_that_there_are_not_are_refused(group: str, levels: str, text: str) -> None:
    with pytest.raises(ValueError, match=text):
        shows(alone(), group, levels)


def test_slower_than_remembers_the_fastest_moment() -> None:
    thymio = alone("motor.left.target = -300\nmotor.right.target = -300", seconds=2.0)
    thymio["motor.left.target"] = 0
    thymio["motor.right.target"] = 0
    thymio.run(1.0)
    assert thymio.speed == 0.0
    assert not slower_than(thymio, 0.08)
    assert slower_than(thymio, 0.11)
    assert slower_than(thymio, 0.01, since=2.9)
    assert repr(slower_than(thymio, 0.05)).startswith("thymio drove -0.")
    fastest = max(abs(moment.speed_m_s) for moment in thymio.path)
    assert slower_than(thymio, fastest)


def test_checks_combine_and_are_judged_when_asked() -> None:
    thymio = alone(DRIVE, seconds=0.0)
    there = reached(thymio, (0.2, 0.0)) & no_contact(thymio)
    assert not there
    thymio.until(there, 10.0)
    assert there
    assert there | reached(thymio, (9, 9))
    assert ~reached(thymio, (9, 9))
    assert "; and thymio touched nothing" in repr(there)


@pytest.mark.process
def test_an_assertion_shows_what_the_check_saw(pytester: pytest.Pytester) -> None:
    pytester.makepyfile(
        """
        from thymio_sim_ros.testing import reached

        def test_it(thymio):
            assert reached(thymio, (0.5, 0))
        """
    )
    result = pytester.runpytest_inprocess("-p", "thymio_sim_ros.pytest_plugin")
    result.stdout.fnmatch_lines(
        ["E *assert thymio is at (0.000, 0.000), 0.500 m from (0.5, 0): expected at most 0.05 m"]
    )


def test_a_check_of_one_s_own_is_one_function() -> None:
    thymio = alone(DRIVE)
    east = Check(lambda: (thymio.pose.x_m > 0, f"x is {thymio.pose.x_m:.1f}: expected more than 0"))
    assert east & no_contact(thymio)
