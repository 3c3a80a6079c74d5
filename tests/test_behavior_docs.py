"""The example of docs/behaviors.md does what its text says."""

from __future__ import annotations

from tests import pages
from tests.device.handheld import HandheldRobot
from thymio_sim_ros.device.programs.program import load_program

GUIDE = pages.read("behaviors.md")


def test_the_example_turns_away_and_goes_back_to_the_menu() -> None:
    (example,) = pages.blocks(GUIDE, "xml")
    robot = HandheldRobot()
    robot.host.load(load_program(example, "shy.aesl"))
    robot.tick(2)
    assert robot.targets == (0, 0)
    robot.device.feed("proximity", (0, 0, 3000, 0, 0, 0, 0))
    robot.tick()
    assert robot.targets == (200, -200)
    assert robot.top == (32, 0, 8)
    robot.touch("center")
    assert robot.running == "menu"
    assert robot.targets == (0, 0)
