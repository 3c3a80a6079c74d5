"""The gallery of playgrounds in a real browser: thumbnails, a choice, and a rejected file that changes nothing."""

from __future__ import annotations

import json

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.conftest import DEADLINE_MS
from tests.web_ui.page_support import MARKS, choose_language, open_page, open_tab
from tests.web_ui.test_page_access import AXE, FINDINGS
from thymio_sim_ros import resources

pytestmark = MARKS

COLORS = """(image) => {
    const canvas = Object.assign(document.createElement("canvas"), {width: 60, height: 40});
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0, 60, 40);
    return new Set(new Uint32Array(context.getImageData(0, 0, 60, 40).data.buffer)).size;
}"""


def open_gallery(page, suite, *arguments):
    open_page(page, suite("--playground", "base", "--program", "none", *arguments))
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")
    page.click("#gallery-open")


def test_every_shipped_playground_has_a_thumbnail_its_name_and_its_robots(suite, page):
    open_gallery(page, suite)
    names = list(resources.playgrounds())
    page.wait_for_function(
        "(count) => [...document.querySelectorAll('.sample img:not([hidden])')]"
        ".filter(({complete, naturalWidth}) => complete && naturalWidth > 0).length === count",
        arg=len(names),
        timeout=3 * DEADLINE_MS,  # each is a rendered scene
    )
    for name in names:
        card = page.locator(f"[data-playground={name}]")
        assert card.locator("img").evaluate(COLORS) > 8, name
    playwright.expect(page.locator("[data-playground=classroom] .count")).to_have_text("20 robots")
    playwright.expect(page.locator("[data-playground=base]")).to_have_attribute("aria-current", "true")
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert page.evaluate(FINDINGS) == []


def test_one_is_chosen_by_keys_in_another_language(suite, page):
    open_page(page, suite("--playground", "base", "--program", "none"))
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")
    choose_language(page, "de")
    page.locator("#gallery-open").press("Enter")
    playwright.expect(page.locator("[data-playground=maze]")).to_contain_text("Labyrinth")
    page.locator("[data-playground=maze]").press("Enter")
    page.wait_for_function("window.thymio.state().simulator.playground === 'maze'")
    playwright.expect(page.locator("dialog.gallery")).to_be_hidden()


def test_escape_closes_the_gallery_and_stops_no_robot(suite, page):
    open_page(page, suite("--playground", "base", "--behaviour", "explorer"))
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")
    page.wait_for_function("window.thymio.state().program?.state === 'running'")
    page.click("#gallery-open")
    page.keyboard.press("Escape")
    playwright.expect(page.locator("dialog.gallery")).to_be_hidden()
    page.locator("#pause").click()
    page.wait_for_function("window.thymio.state().simulator.paused")  # asked for after a stop would have been
    assert page.evaluate("window.thymio.state().program.state") == "running"


def test_a_broken_file_is_rejected_with_location_found_and_expected_and_the_world_stays(suite, page, tmp_path):
    broken = tmp_path / "broken.json"
    broken.write_text(json.dumps({"format": 1, "title": "Broken", "shapes": [{"kind": "box", "x_m": "far"}]}))
    open_gallery(page, suite)
    page.set_input_files("#gallery-file", str(broken))
    fault = page.locator("dialog.gallery div.fault")
    playwright.expect(fault).to_contain_text("broken.json")
    playwright.expect(fault.locator("dd")).to_contain_text(["shapes[0].x_m", "'far'", "a number of m"])
    assert page.evaluate("window.thymio.state().simulator.playground") == "base"


def test_a_file_that_is_not_a_playground_is_rejected_in_plain_words(suite, page, tmp_path):
    letter = tmp_path / "letter.json"
    letter.write_text("hello")
    open_gallery(page, suite)
    page.set_input_files("#gallery-file", str(letter))
    fault = page.locator("dialog.gallery div.fault")
    playwright.expect(fault).to_contain_text("This file is not a playground.")
    playwright.expect(fault.get_by_text("Expecting value")).to_be_hidden()
    fault.locator("summary").click()
    playwright.expect(fault.locator(".technical")).to_contain_text("line 1, column 1")


def test_a_playground_of_the_thesis_is_accepted_and_shows_its_objects(suite, page, tmp_path):
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
    open_gallery(page, suite)
    page.set_input_files("#gallery-file", str(foreign))
    page.wait_for_function("window.thymio.state().simulator.title === 'Lone pillar'")
    page.wait_for_function("window.thymio.state().robot?.latest")
    page.wait_for_function("window.thymio.state().markers > 0")
