"""A mission made in the creator is one file, which the simulator reads and the creator opens again."""

from __future__ import annotations

import zipfile

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.creator_support import choose_more, click, open_creator
from tests.web_ui.page_support import MARKS, go_on_building, wait_for_frame
from tests.web_ui.test_page_access import findings_in_all_sizes
from thymio_sim_ros.missions import load_mission

pytestmark = MARKS


def wait_for_mission(page, expression):
    """Wait until an expression over the mission is true."""
    page.wait_for_function(f"((mission) => {expression})(window.thymio.built().playground.mission)")


def choose(page, selector, value, expected):
    """Choose a value, and wait until the mission has it and the form is built anew."""
    page.locator(selector).select_option(value)
    wait_for_mission(page, expected)
    wait_for_frame(page)


def press(page, selector, expected):
    """The same for a button or a checkbox."""
    page.click(selector)
    wait_for_mission(page, expected)
    wait_for_frame(page)


def write(page, selector, text, expected):
    """The same for a text or a number."""
    field = page.locator(selector)
    field.fill(text)
    field.blur()
    wait_for_mission(page, expected)
    wait_for_frame(page)


def make(page):
    """A mission: two goals one after the other, a reason to fail, a star, hints."""
    page.click("[data-tool=rectangle]")
    click(page, 0.3, 0.2)
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    page.click(".mission-form summary")
    press(page, "[data-verb=make-mission]", "mission !== undefined")
    press(page, "[data-verb=add-goals]", "mission.goals.length === 1")
    press(page, "[data-verb=add-goals]", "mission.goals.length === 2")
    choose(page, '[data-goal="goals[1]"] [data-field=kind]', "lights", "mission.goals[1].kind === 'lights'")
    choose(page, '[data-goal="goals[1]"] [data-field=color]', "green", "mission.goals[1].values.color === 'green'")
    choose(page, "[data-field=order]", "then", "mission.order === 'then'")
    press(page, "[data-verb=add-never]", "mission.never.length === 1")
    write(page, '[data-goal="goals[0]"] [data-field=missing]', "Not there yet", "mission.goals[0].missing !== ''")
    press(page, "[data-verb=add-happens]", "mission.happens.length === 1")
    choose(page, '[data-goal="happens[0]"] [data-field=action]', "hand", "mission.happens[0].hand === 'left'")
    choose(page, '[data-goal="happens[0]"] [data-field=hand]', "away", "mission.happens[0].hand === 'away'")
    press(page, "[data-verb=add-extra]", "mission.extra.length === 1")
    press(page, '[data-goal="extra[0]"] [data-field=once]', "mission.extra[0].once")
    write(page, "[data-field=within_s]", "20", "mission.within_s === 20")
    page.click(".by-hand summary")
    page.fill("#mission-kept", '{"nxt": "wall"}')
    page.locator("#mission-kept").blur()
    playwright.expect(page.locator("#mission-kept-problem")).to_have_text("nxt is no word for this place.")
    write(page, "#mission-kept", '{"next": "wall"}', "mission.kept.next === 'wall'")
    write(page, "#mission-story", "Drive to the square.", "mission.story.endsWith('square.')")
    page.fill("#mission-hints", "Turn left.\nThen stop.")
    page.click("[data-language=vpl]")  # the text is finished by this press, which counts
    wait_for_mission(page, "mission.hints.length === 2 && !mission.languages.includes('vpl')")
    press(page, "[data-programs=solutions] [data-verb=take]", "'text' in mission.solutions")  # it does nothing


def test_a_mission_is_made_saved_and_opened_again(at_rest, page, tmp_path):
    open_creator(page, at_rest)
    make(page)
    assert findings_in_all_sizes(page) == []
    made = page.evaluate("window.thymio.built().playground.mission")
    with page.expect_download() as saving:
        choose_more(page, "save")
    saved = tmp_path / saving.value.suggested_filename
    assert saved.name == "My_playground.zip"
    saving.value.save_as(saved)
    page.locator(".notice", has_text="The solution “Text” does not pass: it gets 0 of 3 stars.").wait_for()
    with zipfile.ZipFile(saved) as archive:
        archive.extractall(tmp_path)
    mission = load_mission(tmp_path / "mission.json")
    assert mission.success == {"then": ["goal_1", "goal_2"]}
    assert mission.failure == "never_1"
    assert [(star.within_s, star.when) for star in mission.stars] == [(20.0, None), (None, {"once": "star_1"})]
    assert (mission.missing_text("goal_1"), mission.next) == ("Not there yet", "wall")
    assert [(each.at_s, type(each.command).__name__) for each in mission.happens] == [(1.0, "SetProximity")]
    assert mission.hints == ("Turn left.", "Then stop.")
    assert mission.text_of("goal_2") == "Its light is green"
    assert list(mission.zones) == ["rectangle_1"]
    page.click("#creator-try")
    page.wait_for_function("window.thymio.state().mission?.title === 'My playground'")
    playwright.expect(page.locator(".mission-form")).to_have_count(0)
    page.get_by_text("Drive to the square.").first.wait_for(state="attached")
    go_on_building(page, "My playground")
    page.click(".mission-form summary")
    page.click("[data-verb=no-mission]")
    page.wait_for_function("window.thymio.built().playground.mission === undefined")
    page.set_input_files("#creator-file", str(saved))
    wait_for_mission(page, "mission?.goals.length === 2")
    opened = page.evaluate("window.thymio.built().playground.mission")
    assert opened == made | {
        "goals": [{**goal, "text": mission.text_of(f"goal_{index}")} for index, goal in enumerate(made["goals"], 1)],
        "never": [{**goal, "text": mission.text_of(f"never_{index}")} for index, goal in enumerate(made["never"], 1)],
        "extra": [{**goal, "text": mission.text_of(f"star_{index}")} for index, goal in enumerate(made["extra"], 1)],
    }


def test_what_is_missing_is_said_and_a_file_that_cannot_be_read_leaves_the_work(at_rest, page, tmp_path):
    open_creator(page, at_rest)
    page.click(".mission-form summary")
    page.click("[data-verb=make-mission]")
    playwright.expect(page.locator(".mission-form .problems")).to_have_text("Add a goal.")
    page.click("[data-verb=add-goals]")
    playwright.expect(page.locator(".mission-form .problems")).to_be_hidden()
    other = tmp_path / "other.zip"
    with zipfile.ZipFile(other, "w") as archive:
        archive.writestr(
            "mission.json", '{"format": 1, "title": "x", "playground": "playground.json", "facts": [], "success": "a"}'
        )
        archive.writestr("playground.json", '{"format": 1, "title": "x", "shapes": [], "robots": []}')
    page.set_input_files("#creator-file", str(other))
    reason = page.locator(".creator .fault .reason")
    playwright.expect(reason).to_contain_text("cannot be read")
    wait_for_mission(page, "mission.goals.length === 1")
