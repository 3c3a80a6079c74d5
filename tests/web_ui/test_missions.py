"""Missions on the page: from the address to the third star, and back to what a pupil has written."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.processes import wait_for_port
from tests.web_ui.page_support import MARKS, build_playground, drop_file, open_page, resize, wait_for_none
from tests.web_ui.test_page_access import AXE, findings
from tests.web_ui.test_page_view import NO_WEBGL
from tests.web_ui.test_welcome import visit
from thymio_sim_ros.missions.shipped import shipped

pytestmark = MARKS

MISSIONS = [each for step in shipped() for each in step.missions]
CARD = ".mission-card"
PASSED = f"{CARD}[data-state=passed]"
OVER_THE_CARD = """() => {
  const card = document.querySelector('.mission-card').getBoundingClientRect();
  return ['.views', '#trouble', '.notice', '#tray'].filter((selector) => {
    const {left, right, top, bottom, height} = document.querySelector(selector)?.getBoundingClientRect() ?? {height: 0};
    return height > 0 && left < card.right && right > card.left && top < card.bottom && bottom > card.top;
  });
}"""


def code_of(path: str) -> str:
    """The code of the only node of a file."""
    found = re.search(r"<node [^>]*>(.*?)</node>", Path(path).read_text(encoding="utf-8"), re.DOTALL)
    assert found is not None
    return found[1].split("<toolsPlugins>")[0].replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&").strip()


def choose(page, name):
    """Choose a mission of the list, which is open."""
    page.locator(f"[data-mission={name}]").click()
    page.locator(CARD).wait_for()
    page.wait_for_function("(name) => window.thymio.state().mission?.name === name", arg=name)


def write(page, code):
    """Write a program in the text editor of the mission."""
    page.locator("[data-mission-language=text]").click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(code)


def run(page):
    page.locator("[data-verb=run]").click()


def text_of(page):
    return page.locator(".cm-content").inner_text().strip()


def test_from_the_address_to_the_third_star_and_back(suite, own_page):
    page = own_page
    address = suite("--real-time-factor", "4")
    wait_for_port(int(address.rsplit(":", 1)[1].strip("/")))
    visit(page, address)
    page.locator("[data-start=missions]").click()
    page.locator(".mission-choice").first.wait_for()
    assert page.locator(".mission-choice").count() == len(MISSIONS)
    titles = [f"{at}. {step.titles['en']}" for at, step in enumerate(shipped(), start=1)]
    assert page.locator(".mission-list h3").all_inner_texts() == titles
    first, second = MISSIONS[0], MISSIONS[1]
    choose(page, first.name)
    languages = page.locator("[data-mission-language]")
    assert languages.evaluate_all("(all) => all.map((one) => one.dataset.missionLanguage)") == list(
        first.mission.languages
    )
    write(page, code_of(first.mission.solutions["text"]))
    run(page)
    page.locator(PASSED).wait_for()
    playwright.expect(page.locator(".mission-done")).to_have_count(page.locator(".mission-checklist li").count())
    assert "paint/way/0" in page.evaluate("window.thymio.state().missionMarkers")
    playwright.expect(page.locator(".mission-result .mission-star:not(.mission-no)")).to_have_count(3)

    resize(page, 390, 844)
    page.locator("[data-mission-do=next]").click()  # in the same language, and on a phone the task is read first
    page.wait_for_function("(name) => window.thymio.state().mission?.name === name", arg=second.name)
    page.locator("[data-mission-language=text][aria-pressed=true]").wait_for()
    page.locator(".mission-story").wait_for()
    playwright.expect(page.locator(".cm-content")).to_contain_text("motor.left.target = 200")
    page.locator("[data-mission-language=text]").click()
    page.locator(".mission-story").wait_for(state="hidden")
    resize(page, 1024, 768)

    page.locator("#missions-open").click()  # the list knows the stars, also after the page was loaded again
    stars = page.locator(f"[data-mission={first.name}] .mission-star:not(.mission-no)")
    playwright.expect(stars).to_have_count(3)
    page.keyboard.press("Escape")
    open_page(page, address)
    page.locator("#missions-open").click()
    choose(page, first.name)
    page.locator(".cm-content").wait_for()  # in the language of the last time, with what was written
    assert text_of(page).split() == code_of(first.mission.solutions["text"]).split()

    suite.end()  # a lost server takes nothing away
    page.wait_for_function("window.thymio.state().connection === 'lost'")
    assert page.evaluate("JSON.parse(localStorage.getItem('missions.stars'))")[first.name] > 0


def test_a_try_that_fails_says_what_was_missing_and_helps(world, page):
    open_page(page, world("base", "none"))
    page.locator("#missions-open").click()
    choose(page, "forward")
    page.locator("[data-mission-language=text]").click()
    page.locator(".cm-content").click()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("motor.left.target = 500\nmotor.right.target = 500")
    page.locator("[data-mission-do=hint]").click()
    hint = MISSIONS[0].mission.hints[0]
    playwright.expect(page.locator(".mission-hints li")).to_have_text([hint])
    page.locator("[data-mission-do=step]").click()
    playwright.expect(page.locator(".mission-step")).to_contain_text("onevent buttons")
    run(page)
    page.locator(f"{CARD}[data-state=failed]").wait_for()
    playwright.expect(page.locator(".mission-result")).to_contain_text(MISSIONS[0].mission.text_of("crash"))
    page.locator("[data-mission-do=again]").click()
    page.locator(f"{CARD}[data-state=running]").wait_for()
    page.locator(".mission-task summary").click()
    page.locator(f"{CARD}[data-state=failed]").wait_for()
    page.locator("[data-mission-do=leave]").click()  # the task stays open, though the try has ended meanwhile
    page.locator(CARD).wait_for(state="detached")
    assert page.evaluate("window.thymio.state().missionMarkers") == []


def test_only_the_languages_of_the_mission_are_offered_and_own_work_stays(world, page, tmp_path):
    open_page(page, world("base", "none"))
    page.locator("#tab-program").click()
    page.locator("[data-new=empty]").click()
    page.locator(".cm-content").click()
    page.keyboard.insert_text("# my own work")
    file = {"format": 1, "title": "<img src=x onerror=alert(1)>", "playground": "desk", "success": "far"}
    file |= {"facts": {"far": {"kind": "driven", "distance_m": 0.1}}, "languages": ["text"]}
    mission = tmp_path / "mine.json"
    mission.write_text(json.dumps(file))
    page.locator("#missions-open").click()
    page.locator("#mission-file").set_input_files(str(mission))
    page.locator(CARD).wait_for()
    assert page.locator(".mission-title").inner_text() == file["title"]
    assert page.locator(f"{CARD} img").count() == 0
    page.locator(".cm-content").wait_for()
    playwright.expect(page.locator(".cm-content")).not_to_contain_text("my own work")
    assert page.locator(".seg [data-language]:visible").evaluate_all(
        "(all) => all.map((one) => one.dataset.language)"
    ) == ["text"]
    kept = page.evaluate("JSON.parse(localStorage.getItem('editor.recent'))")
    assert any("my own work" in each["text"] for each in kept)

    mission.write_text(json.dumps(file | {"success": "fat"}))  # a refused file leaves the open mission as it is
    drop_file(page, mission, "#view")
    notice = page.locator(".notice.error")
    notice.locator("summary").click()
    playwright.expect(notice).to_contain_text("mine.json: success: found 'fat', expected a fact: 'far'")
    assert page.locator(CARD).is_visible()


def test_nothing_lies_over_the_card_of_a_mission(world, own_page, tmp_path):
    page = own_page
    page.add_init_script(NO_WEBGL)
    open_page(page, world("base", "none"))
    page.locator("#missions-open").click()
    choose(page, "forward")
    note = page.locator("#trouble")
    for width, height in ((1024, 768), (844, 390), (390, 844)):
        resize(page, width, height)
        wait_for_none(page, OVER_THE_CARD)
        assert note.is_visible() == (width > 400), "beside it if there is room"
    page.locator("#mission-fold").click()
    note.wait_for()
    wait_for_none(page, OVER_THE_CARD)
    page.locator("#mission-fold").click()
    refused = tmp_path / "refused.json"
    refused.write_text(json.dumps({"format": 1, "facts": {}, "success": "far"}))
    drop_file(page, refused, "#view")
    page.locator(".notice.error").wait_for()
    wait_for_none(page, OVER_THE_CARD)


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1280, 800), (1024, 768), (390, 844)])
def test_all_parts_of_missions_are_accessible(world, page, size):
    if not AXE.exists():
        pytest.skip("axe is not installed")
    open_page(page, world("base", "none"))
    resize(page, *size)
    page.add_script_tag(path=str(AXE))
    page.evaluate("document.querySelector('#help-open').click()")
    page.locator("[data-help=missions]").click()
    page.locator(".mission-choice").first.wait_for()
    assert findings(page) == []
    focused = "document.activeElement.dataset.mission"
    assert page.evaluate(focused) == MISSIONS[0].name  # Enter starts it
    page.keyboard.press("Enter")
    page.locator(CARD).wait_for()
    page.locator("[data-mission-language]").first.wait_for()
    assert findings(page) == []
    write(page, "motor.left.target = 500\nmotor.right.target = 500")
    page.evaluate("document.querySelector('[data-mission-do=hint]').click()")
    page.evaluate("document.querySelector('[data-verb=run]').click()")
    page.locator(f"{CARD}[data-state=failed]").wait_for()
    assert findings(page) == [], "after a try"
    page.evaluate("document.querySelector('#file-menu').click()")
    page.evaluate("document.querySelector('[data-verb=share]').click()")
    page.locator(".sharing .sharing-qr").wait_for()
    assert findings(page) == [], "sharing"
    page.keyboard.press("Escape")
    page.evaluate("document.querySelector('#missions-open').click()")
    choose(page, "first_node")
    page.locator(".python .cm-content").wait_for()
    assert findings(page) == [], "a node"
    page.locator(".cm-content").fill("1 / 0")
    page.evaluate("document.querySelector('[data-verb=run]').click()")
    page.locator(".python-error").wait_for()
    assert findings(page) == [], "a node with a mistake"
    build_playground(page)
    page.locator(".mission-form summary").first.click()
    page.locator("[data-verb=make-mission]").click()
    for part in ("goals", "never", "happens", "extra"):
        page.locator(f"[data-verb=add-{part}]").click()
        page.locator(f"[data-goal='{part}[0]']").wait_for()
    page.locator(".by-hand summary").click()
    assert findings(page) == [], "made in the creator"
