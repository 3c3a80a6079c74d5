"""The page of a suite in a namespace, with another suite in the same domain: it controls its own robot."""

from __future__ import annotations

from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    MARKS,
    choose_playground,
    drop_file,
    open_editor,
    open_hands,
    open_page,
    wait_for_position,
    wait_for_program,
    wait_for_service,
)

pytestmark = MARKS

SWITCH = """\
onevent button.center
if button.center == 1 then
    motor.left.target = 150
    motor.right.target = 150
end
"""
X = "window.thymio.state().robot.latest.pose.x"


def of(namespace):
    return ("--ros-args", "-r", f"__ns:={namespace}", "-r", f"/clock:={namespace}/clock")


@pytest.mark.slow
def test_the_page_drives_the_robot_of_its_namespace(suite, page, other_page, tmp_path):
    program = tmp_path / "switch.aesl"
    program.write_text(SWITCH)
    open_page(other_page, suite("--playground", "obstacle", "--program", "none", *of("/lab2")))
    open_page(page, suite("--playground", "base", "--program", str(program), *of("/lab1")))
    for one, playground in ((page, "base"), (other_page, "obstacle")):
        one.wait_for_function("(name) => window.thymio.state().simulator.playground === name", arg=playground)
        assert one.evaluate("Object.keys(window.thymio.state().robots)") == [""]

    wait_for_program(page, "switch.aesl")
    before, start = other_page.evaluate(X), page.evaluate(X)
    place = wait_for_position(page, "button.center")
    page.mouse.move(place["x"], place["y"])
    page.mouse.down()
    page.wait_for_function("() => window.thymio.state().robot.buttons.center === true")
    page.mouse.up()
    page.wait_for_function(f"(start) => Math.abs({X} - start) > 0.02", arg=start)
    assert other_page.evaluate(X) == before

    wait_for_service(page, "/simulator/pause", "/simulator/reset", "/aseba_runtime/check")
    page.click("#pause")
    page.wait_for_function("() => window.thymio.state().simulator.paused")
    assert not other_page.evaluate("window.thymio.state().simulator.paused")
    page.click("#pause")
    page.wait_for_function("() => !window.thymio.state().simulator.paused")

    broken = tmp_path / "broken.aesl"
    broken.write_text("var a\nonevent prox\n  motor.left.targt = 5\n")
    drop_file(page, broken, "#view")
    playwright.expect(page.locator("body")).to_contain_text("line 3", ignore_case=True, use_inner_text=True)
    assert Path(page.evaluate("window.thymio.state().program.name")).name == "switch.aesl"
    choose_playground(page, "maze")
    page.wait_for_function("() => window.thymio.state().simulator.playground === 'maze'")
    open_hands(page, "pen")
    page.click("[data-pen=down]")

    open_editor(page)
    page.focus(".cm-content")
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("call leds.top(32, 0, 0)\n")
    playwright.expect(page.locator(".verdict")).to_contain_text("No mistakes")
    page.keyboard.press("Control+Enter")
    page.wait_for_function("() => window.thymio.state().robot.leds.top?.[0] === 1")
