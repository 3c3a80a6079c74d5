"""The log of the run, saved from the page."""

from __future__ import annotations

import json
import subprocess
import sys
from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.patience import PROGRAM_S
from tests.web_ui.page_support import (
    MARKS,
    choose_example,
    choose_playground,
    choose_robot,
    open_editor,
    open_hands,
    open_menu,
    open_page,
    wait_for_service,
)
from tests.web_ui.test_editor import AVOIDER, PROGRAM, click_beside, edit_variable, write
from thymio_sim_ros.engine.replay import replay

pytestmark = MARKS


def test_the_run_is_saved_as_a_file_that_repeats_it(world, page, tmp_path):
    open_page(page, world("two_robots", program="explorer"))
    page.wait_for_function("() => window.thymio.state().services.includes('/simulator/get_run_log')")
    page.wait_for_function("() => window.thymio.state().timeNs > 2e9")
    open_menu(page, "#help-open")
    with page.expect_download() as saving:
        page.click("[data-help=run]")
    path = tmp_path / saving.value.suggested_filename
    saving.value.save_as(path)
    found = replay(path)
    assert (path.name, found.differs) == ("run.jsonl.gz", None)
    assert found.ticks >= 100


RUNAWAY = "while 1 == 1 do\nend\n"
WITHOUT_WASMTIME = (
    "import sys; sys.modules['wasmtime'] = None; from thymio_sim_ros.cli.main import main; sys.exit(main())"
)


def let_it_run(page: Any, seconds: float) -> None:
    """Wait until simulated time has gone on by so much."""
    begun = page.evaluate("() => window.thymio.state().timeNs")
    page.wait_for_function("(end) => window.thymio.state().timeNs >= end", arg=begun + seconds * 1e9)


@pytest.mark.slow
def test_a_lesson_of_five_minutes_is_repeated_bit_for_bit(suite, page, tmp_path):
    log = tmp_path / "lesson.jsonl"
    open_page(page, suite("--playground", "two_robots", "--log", str(log), "--real-time-factor", "5"))
    wait_for_service(page, "/aseba_runtime/check", "/red/aseba/set_variables", "/red/aseba/step_line")
    state = page.locator("#program-state")

    # a text, edited while it runs, with a breakpoint and a value set by hand
    choose_robot(page, "red")
    open_editor(page)
    write(page, PROGRAM)
    page.keyboard.press("Control+Enter")
    playwright.expect(state).to_have_text("running")
    let_it_run(page, 20)
    click_beside(page, 4)
    playwright.expect(state).to_have_text("halted in line 4")
    edit_variable(page, "count", "41")
    playwright.expect(page.locator("[data-variable=count]")).to_have_text("41")
    page.focus(".cm-content")
    page.keyboard.press("F7")
    playwright.expect(page.locator(".current-line")).to_have_text("if count > 30000 then")
    click_beside(page, 4)
    page.keyboard.press("F9")
    playwright.expect(state).to_have_text("running")
    write(page, AVOIDER)
    page.keyboard.press("Control+Enter")
    let_it_run(page, 40)

    # the other robot: an example, hands, buttons, a pause and single steps of time
    choose_robot(page, "blue")
    choose_example(page, "explorer")
    let_it_run(page, 30)
    lift = page.locator("[data-hand=lift]")
    lift.click()
    let_it_run(page, 5)
    lift.click()
    open_hands(page, "hand")
    page.get_by_role("button", name="in front", exact=True).click()
    let_it_run(page, 5)
    page.get_by_role("button", name="Take the hand away").click()
    page.keyboard.press("Escape")
    page.click("#time [data-verb=pause]")
    page.wait_for_function("() => window.thymio.state().simulator.paused")
    for _ in range(3):
        page.click("#time [data-verb=step]")
    page.click("#time [data-verb=pause]")
    let_it_run(page, 30)

    # a program without an end on both, then one that stops
    choose_robot(page, "*")
    open_editor(page)
    write(page, RUNAWAY)
    page.keyboard.press("Control+Enter")
    let_it_run(page, 10)
    page.get_by_role("button", name="Stop program").click()
    write(page, AVOIDER)
    page.keyboard.press("Control+Enter")
    let_it_run(page, 40)

    # another playground, and the rest of five minutes
    choose_playground(page, "desk")
    page.wait_for_function("() => window.thymio.state().simulator.playground === 'desk'")
    choose_example(page, "explorer")
    let_it_run(page, 120)
    suite.end()

    found = replay(log)
    assert (found.differs, found.is_complete) == (None, True)
    assert found.seconds >= 300
    command = [sys.executable, "-c", WITHOUT_WASMTIME, "replay", str(log)]
    interpreted = subprocess.run(command, capture_output=True, text=True, timeout=PROGRAM_S, check=False)
    assert (interpreted.returncode, json.loads(interpreted.stdout)["identical"]) == (0, True), interpreted.stderr
