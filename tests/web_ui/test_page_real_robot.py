"""The page of a robot behind an Aseba port: it drives the robot, and offers nothing that only a simulator can do."""

from __future__ import annotations

from urllib.parse import urlsplit

import pytest

pytest.importorskip("playwright.sync_api")

from tests.network.served_robot import ServedRobot
from tests.processes import free_port, wait_for_port
from tests.web_ui.page_support import MARKS, open_page, open_tab, wait_for_program, without_welcome

pytestmark = MARKS

DRIVE = "motor.left.target = 100\nmotor.right.target = 100\n"


def of(namespace):
    return ("--ros-args", "-r", f"__ns:={namespace}", "-r", f"/clock:={namespace}/clock")


@pytest.mark.slow
def test_a_real_robot_is_driven_and_its_time_is_left_alone(suite, page, other_page, tmp_path):
    program = tmp_path / "drive.aesl"
    program.write_text(DRIVE)
    port = free_port()
    simulated = suite("--playground", "base", "--program", "none", "--aseba-port", str(port), *of("/simulated"))
    wait_for_port(port)
    address = suite("--robot", f"tcp:localhost:{port}", "--program", str(program), *of("/real"))
    wait_for_port(urlsplit(address).port)
    page.goto(without_welcome(address))
    page.wait_for_function("window.thymio?.connected")
    wait_for_program(page, "drive.aesl")
    page.locator(".real-robot").wait_for()
    assert page.locator("#pause, #speed, .clock, #tray-fold, #tray-unfold").locator("visible=true").count() == 0
    assert page.locator("#stop").is_visible()
    assert not page.locator("#tray").is_visible()  # it was an empty card
    assert not page.locator("[data-view=move]").is_visible()
    open_tab(page, "playground")
    page.get_by_text("there is no playground to open").wait_for()
    assert not page.locator("[data-edit], [data-new], #playground-file").locator("visible=true").count()
    open_page(other_page, simulated)
    other_page.wait_for_function("() => window.thymio.state().robot.latest?.pose.x > 0.05")


@pytest.mark.slow
def test_the_page_says_when_the_connection_to_the_robot_is_lost(suite, page):
    robot = ServedRobot()
    try:
        address = suite("--robot", f"tcp:localhost:{robot.port}", *of("/lost"))
        wait_for_port(urlsplit(address).port)
        page.goto(without_welcome(address))
        page.get_by_text("Real robot: its time").wait_for()
        robot.close()
        page.get_by_text("No connection to the robot").wait_for()
        robot = ServedRobot(port=robot.port)
        page.get_by_text("Real robot: its time").wait_for()
    finally:
        robot.close()
