"""What programs of VPL do in the simulated world."""

from __future__ import annotations

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
