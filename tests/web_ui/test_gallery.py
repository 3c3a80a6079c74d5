"""The tab of playgrounds in a real browser: thumbnails, a choice, own ones, and rejected files that change nothing."""

from __future__ import annotations

import json
import zipfile

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.patience import PATIENCE_MS
from tests.sim.builders import FLOOR
from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_language,
    drop_file,
    go_on_building,
    open_page,
    open_tab,
)
from tests.web_ui.test_page_access import AXE, FINDINGS
from thymio_sim_ros.files import resources

pytestmark = MARKS


COLORS = """(image) => {
    const canvas = Object.assign(document.createElement("canvas"), {width: 60, height: 40});
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0, 60, 40);
    return new Set(new Uint32Array(context.getImageData(0, 0, 60, 40).data.buffer)).size;
}"""


def open_gallery(page, address):
    open_page(page, address)
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")


@pytest.mark.slow
def test_every_shipped_playground_has_a_thumbnail_its_name_and_its_robots(at_rest, page):
    open_gallery(page, at_rest)
    for name in resources.playgrounds():
        card = page.locator(f"[data-playground={name}]")
        card.scroll_into_view_if_needed()
        picture = card.locator("img:not([hidden])")
        picture.wait_for(timeout=3 * PATIENCE_MS)  # each is a rendered scene
        picture.evaluate("(image) => image.decode()")
        assert picture.evaluate(COLORS) > 8, name
    playwright.expect(page.locator("[data-playground=classroom] .count")).to_have_text("20 robots")
    playwright.expect(page.locator("[data-playground=base]")).to_have_attribute("aria-current", "true")
    playwright.expect(page.locator(".current h2")).to_have_text("Base")
    playwright.expect(page.locator(".current img")).to_be_visible()
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []


@pytest.mark.slow
def test_thumbnails_are_drawn_when_they_come_into_sight(at_rest, page):
    open_gallery(page, at_rest)
    page.locator("[data-playground] img:not([hidden])").first.wait_for()
    assert page.locator(".gallery .sample").last.locator("img").is_hidden()


def test_one_is_chosen_by_keys_in_another_language(world, page):
    open_page(page, world("base"))
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")
    choose_language(page, "de")
    playwright.expect(page.locator("[data-playground=maze]")).to_contain_text("Labyrinth")
    page.locator("[data-playground=maze]").press("Enter")
    page.wait_for_function("window.thymio.state().simulator.playground === 'maze'")
    playwright.expect(page.locator(".current h2")).to_have_text("Labyrinth")
    playwright.expect(page.locator("[data-playground=maze]")).to_have_attribute("aria-current", "true")


@pytest.mark.slow
def test_own_playgrounds_are_listed_put_on_the_desk_continued_removed_and_brought_back(world, page):
    open_gallery(page, world("base"))
    own = page.locator("section.own")
    playwright.expect(own).to_be_hidden()
    for title in ("First", "Second"):
        build_playground(page)
        page.locator("[data-field=title]").fill(title)
        page.locator("[data-field=title]").press("Enter")
        playwright.expect(page.locator(".kept")).to_have_text("Saved on this device")
        page.click(".creator .leave")
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected && window.thymio.state().simulator !== null")
    cards = own.locator(".sample strong")
    playwright.expect(cards).to_have_text(["Second", "First"])
    cards.nth(1).click()
    page.wait_for_function("window.thymio.state().simulator.title === 'First'")
    own.get_by_role("button", name="Remove First from this device").click()
    playwright.expect(own.locator(".removed")).to_contain_text("First was removed.")
    own.get_by_role("button", name="Bring it back").click()
    playwright.expect(cards).to_have_text(["First", "Second"])
    own.get_by_role("button", name="Remove Second from this device").click()
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected && window.thymio.state().simulator !== null")
    playwright.expect(cards).to_have_text(["First"])
    go_on_building(page, "First")
    page.wait_for_function("window.thymio.built().playground.title === 'First'")


def test_one_of_several_playgrounds_in_an_archive_is_chosen_from_a_list(at_rest, page, tmp_path):
    archive = tmp_path / "maps.zip"
    with zipfile.ZipFile(archive, "w") as packed:
        for title in ("Maze", "Meadow"):
            packed.writestr(f"maps/{title}.json", json.dumps({"format": 1, "title": title, "shapes": [FLOOR]}))
    open_gallery(page, at_rest)
    page.set_input_files("#playground-file", str(archive))
    fault = page.locator(".current > .fault")
    playwright.expect(fault.locator(".headline")).to_have_text("maps.zip holds 2 playgrounds. Choose one.")
    playwright.expect(fault.locator(".parts button")).to_have_text(["maps/Maze.json", "maps/Meadow.json"])
    fault.get_by_role("button", name="maps/Meadow.json").click()
    page.wait_for_function("window.thymio.state().simulator.title === 'Meadow'")
    playwright.expect(fault).to_be_hidden()


@pytest.mark.slow
def test_a_broken_file_is_rejected_in_one_sentence_with_details_and_the_world_stays(at_rest, page, tmp_path):
    broken = tmp_path / "broken.json"
    broken.write_text(json.dumps({"format": 1, "title": "Broken", "shapes": [{"kind": "box", "x_m": "far"}]}))
    open_gallery(page, at_rest)
    page.set_input_files("#playground-file", str(broken))
    fault = page.locator(".current > .fault")
    playwright.expect(fault).to_contain_text("broken.json")
    playwright.expect(fault.locator(".reason")).to_have_text("Thing 1: Position x must be from -10000 to 10000 cm.")
    technical = fault.locator(".technical p")
    playwright.expect(technical).to_be_hidden()
    playwright.expect(technical).to_contain_text("shapes[0].x_m: found 'far', expected a number of m")
    assert page.evaluate("window.thymio.state().simulator.playground") == "base"


@pytest.mark.slow
def test_a_file_that_is_not_a_playground_is_rejected_in_plain_words(at_rest, page, tmp_path):
    letter = tmp_path / "letter.json"
    letter.write_text("hello")
    open_gallery(page, at_rest)
    page.set_input_files("#playground-file", str(letter))
    fault = page.locator(".current > .fault")
    playwright.expect(fault).to_contain_text("This file is not a playground.")
    playwright.expect(fault.get_by_text("Expecting value")).to_be_hidden()
    fault.locator("summary").click()
    playwright.expect(fault.locator(".technical p")).to_be_visible()
    playwright.expect(fault.locator(".technical p")).to_contain_text("line 1, column 1")


@pytest.mark.slow
def test_a_dropped_file_is_refused_where_it_was_dropped_in_the_language_of_the_page(world, page, tmp_path):
    broken = tmp_path / "kaputt.json"
    shape = {"kind": "box", "name": "crate", "x_m": 0, "y_m": 0, "size_x_m": 0, "size_y_m": 1, "height_m": 1}
    broken.write_text(json.dumps({"format": 1, "title": "x", "shapes": [shape | {"color": "#112233"}]}))
    open_page(page, world("base", behaviour="explorer"))
    page.wait_for_function("window.thymio.state().program?.state === 'running'")
    choose_language(page, "de")
    drop_file(page, broken, "#view")
    message = page.locator(".message-at")
    playwright.expect(message.locator(".reason")).to_have_text("Kiste „crate“: Länge muss von 0.1 bis 10000 cm sein.")
    playwright.expect(message.locator(".headline")).to_contain_text("kaputt.json")
    assert page.locator(".notice").count() == 0
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []
    page.keyboard.press("Escape")
    playwright.expect(message).to_be_hidden()
    page.locator("#pause").click()
    page.wait_for_function("window.thymio.state().simulator.paused")  # asked for after a stop would have been
    assert page.evaluate("window.thymio.state().program.state") == "running"


@pytest.mark.slow
def test_a_playground_of_the_thesis_is_accepted_and_shows_its_objects(world, page, tmp_path):
    foreign = tmp_path / "mine.json"
    pillar = {"topRadius": 2, "botRadius": 2, "height": 6, "color": "#9fa3bd", "positionX": 20, "positionZ": 0}
    floor = {"name": "ground", "props": {"width": 50, "height": 50, "color": "#bdbbbb"}, "hasWalls": True}
    robot = {"name": "thymio", "positionX": 0, "positionZ": 0}
    foreign.write_text(
        json.dumps(
            {
                "playground": "Lone pillar",
                "planes": [floor],
                "cylinders": [{"name": "pillar", "props": pillar}],
                "thymios": robot,
            }
        )
    )
    open_gallery(page, world("base"))
    page.set_input_files("#playground-file", str(foreign))
    page.wait_for_function("window.thymio.state().simulator.title === 'Lone pillar'")
    page.wait_for_function("window.thymio.state().robot?.latest")
    page.wait_for_function("window.thymio.state().markers > 0")
