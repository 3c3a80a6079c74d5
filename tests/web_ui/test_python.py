"""ROS nodes in Python on the page: a mission from its start to all stars, an error, and pages that may not run them."""

from __future__ import annotations

from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.patience import PROGRAM_S
from tests.web_ui.page_support import MARKS, drop_file, open_page
from tests.web_ui.test_missions import CARD, PASSED, choose, run
from thymio_sim_ros.missions import Mission
from thymio_sim_ros.missions.shipped import shipped

pytestmark = MARKS

NODES: dict[str, Mission] = {
    each.name: each.mission for step in shipped() for each in step.missions if "ros" in each.mission.languages
}
STATE = "#python-state"


def write(page, code):
    """Write a program in the editor, which is open."""
    page.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(code)


def solution(name):
    return Path(NODES[name].solutions["ros"]).read_text(encoding="utf-8")


@pytest.mark.parametrize("name", ["first_node", pytest.param("node_line", marks=pytest.mark.slow)])
def test_the_solution_of_a_mission_gets_all_stars_as_it_does_headless(world, page, name):
    open_page(page, world("base", "none"))
    page.locator("#missions-open").click()
    choose(page, name)
    start = Path(NODES[name].programs["ros"]).read_text(encoding="utf-8")
    page.locator(".cm-content").wait_for()
    assert start.splitlines()[0] in page.locator(".cm-content").inner_text()
    assert page.locator(".mission-command").count() == 0  # no terminal is needed
    page.locator("[data-mission-do=step]").click()
    playwright.expect(page.locator(".mission-step")).to_be_visible()
    write(page, solution(name))
    run(page)
    page.locator(f"{PASSED}, {CARD}[data-state=failed]").wait_for(
        timeout=1000 * PROGRAM_S
    )  # half a minute in real time
    assert page.evaluate("window.thymio.state().attempt.stars") == [True] * (1 + len(NODES[name].stars))
    page.locator("[data-verb=stop]").click()
    playwright.expect(page.locator(STATE)).to_have_text("ended")


def test_an_error_leads_to_its_line_and_a_try_again_runs_the_node(world, page):
    open_page(page, world("base", "none"))
    page.locator("#missions-open").click()
    choose(page, "first_node")
    page.locator(".cm-content").wait_for()
    write(page, solution("first_node").replace("seen.range", "seen.rage"))
    run(page)
    playwright.expect(page.locator(".python-error")).to_contain_text("AttributeError: ")
    line = page.locator(".cm-lintRange-error")
    playwright.expect(line).to_contain_text("seen.rage")
    playwright.expect(page.locator(".python-output")).to_contain_text("Traceback (most recent call last)")
    write(page, solution("first_node"))
    playwright.expect(line).to_have_count(0)  # it is about another text
    run(page)
    playwright.expect(page.locator(STATE)).to_have_text("running")
    tries = page.evaluate("window.thymio.state().attempt.tries")
    page.locator("#time [data-verb=reset]").click()
    page.wait_for_function("(tries) => window.thymio.state().attempt.tries > tries", arg=tries)
    playwright.expect(page.locator(STATE)).to_have_text("running")  # the node began anew
    page.locator("#stop").click()
    playwright.expect(page.locator(STATE)).to_have_text("ended")


@pytest.mark.slow
def test_a_node_is_kept_opened_and_saved_as_a_file(world, page, tmp_path):
    address = world("base", "none")
    open_page(page, address)
    file = tmp_path / "hello.py"
    file.write_text("print('hello from a file')\n")
    drop_file(page, file, "#view")
    page.locator(".cm-content").wait_for()
    run(page)
    playwright.expect(page.locator(".python-output")).to_contain_text("hello from a file")
    page.locator(".cm-content").click()
    page.keyboard.press("Control+End")
    page.keyboard.insert_text("# more")
    page.locator("#file-menu").click()
    assert page.locator("[data-verb=load]").is_hidden()
    with page.expect_download() as saved:
        page.locator("[data-verb=save]").click()
    assert saved.value.suggested_filename == "hello.py"
    assert Path(saved.value.path()).read_text(encoding="utf-8") == "print('hello from a file')\n# more"
    open_page(page, address)
    page.locator("#tab-program").click()
    page.locator("[data-recent='hello.py']").click()
    playwright.expect(page.locator(".cm-content")).to_contain_text("# more")


def test_where_nodes_do_not_run_a_mission_says_what_to_do(suite, own_page):
    page = own_page
    open_page(page, suite("--no-nodes"))
    page.locator("#missions-open").click()
    choose(page, "first_node")
    playwright.expect(page.locator(".mission-command")).to_contain_text("thymio-sim node")
    page.locator(f"{CARD} [data-mission-do=leave]").click()
    page.locator("#tab-program").click()
    page.locator("[data-language=text]").wait_for()
    assert page.locator("[data-language=ros]").is_hidden()
