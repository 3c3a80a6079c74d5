"""What programs of VPL do in the simulated world."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from thymio_sim_ros.testing import emitted, followed_line, no_contact

PROGRAMS = Path(__file__).parents[1] / "data" / "web" / "vpl"


@pytest.mark.thymio(playground="arena", program=PROGRAMS / "avoid.aesl")
def test_the_obstacle_avoider_avoids(thymio):
    thymio.run(40)
    assert no_contact(thymio)
    assert emitted(thymio, "pair_run", [0])


@pytest.mark.thymio(playground="line", program=PROGRAMS / "line.aesl")
def test_the_line_follower_follows_the_line(thymio):
    thymio.until(followed_line(thymio), seconds=240)


@pytest.mark.thymio(playground="line", program=PROGRAMS / "events.aesl")
def test_what_a_pupil_does_triggers_each_event_with_its_default_values(thymio):
    """Rows in order: button, something near in front, white under both ground sensors, tap, clap, black."""
    thymio.run(1)
    assert emitted(thymio, "pair_run", [5])  # it starts on the line
    actions = {
        0: lambda: thymio.press("forward"),
        1: lambda: thymio.place(0.68, 0.0),  # 4 cm in front of the wall
        2: lambda: thymio.place(0.0, -0.1),
        3: thymio.tap,
        4: thymio.clap,
    }
    assert not any(emitted(thymio, "pair_run", [row]) for row in (0, 1, 3, 4))
    for row, act in actions.items():
        act()
        thymio.run(1)
        assert emitted(thymio, "pair_run", [row]), row


TILTED = {0: (1, 0), 1: (-1, 0), 2: (0, -1), 3: (0, 1)}
"""Roll and pitch of 45 degrees, by row: left side up, right side up, front up, rear up."""
LEVEL = 4
"""The row of a roll of 0 degrees, which stays so while the robot is pitched."""


@pytest.mark.parametrize("row", TILTED)
@pytest.mark.thymio(playground="base", program=PROGRAMS / "tilt.aesl")
def test_a_tilt_within_7_5_degrees_of_that_of_the_block_triggers_it_once(thymio, row):
    def tilt(degrees: float) -> None:
        angles = [side * math.radians(degrees) for side in TILTED[row]]
        thymio.tilt(*angles)
        thymio.run(0.5)

    thymio.run(0.5)
    assert emitted(thymio, "pair_run", [LEVEL], times=1)
    for degrees, times in ((33, 0), (40, 1), (50, 1), (57, 1), (45, 2), (90, 2)):
        tilt(degrees)
        assert emitted(thymio, "pair_run", [row], times=times), degrees
    assert emitted(thymio, "pair_run", [LEVEL], times=1)
    tilt(0)
    assert emitted(thymio, "pair_run", [LEVEL], times=2 if TILTED[row][0] else 1)
    for other in TILTED:
        assert emitted(thymio, "pair_run", [other], times=2 if other == row else 0)
