"""What the creator opens: files, shipped playgrounds, the one that is running."""

from __future__ import annotations

import json

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.creator_support import items, open_creator
from tests.web_ui.page_support import MARKS, open_page, open_tab, wait_for_service

pytestmark = MARKS


@pytest.mark.slow
def test_a_broken_file_is_rejected_with_its_location_and_the_playground_is_unchanged(at_rest, page, tmp_path):
    broken = tmp_path / "broken.json"
    broken.write_text(json.dumps({"format": 1, "title": "x", "shapes": [{"kind": "box", "x_m": "far"}]}))
    open_creator(page, at_rest)
    page.set_input_files("#creator-file", str(broken))
    fault = page.locator(".creator .fault")
    playwright.expect(fault.locator(".reason")).to_have_text("Thing 1: Position x must be from -10000 to 10000 cm.")
    playwright.expect(fault.locator(".technical p")).to_contain_text('shapes[0].x_m: found "far"')
    assert sorted(items(page)) == ["ground", "thymio"]


@pytest.mark.slow
def test_a_copy_of_a_shipped_playground_is_edited(at_rest, page):
    open_page(page, at_rest)
    page.wait_for_function("window.thymio.state().playgrounds.length > 3")
    open_tab(page, "playground")
    page.get_by_role("button", name="Edit a copy of Gate", exact=True).click()
    page.wait_for_function("window.thymio.built()?.playground.title === 'Gate'")
    page.click("[data-verb=undo]")
    page.wait_for_function("window.thymio.built().playground.title === 'My playground'")


def test_a_running_aseba_playground_is_edited(world, page, tmp_path):
    foreign = tmp_path / "arena.playground"
    wall = '<wall x="20" y="80" l1="20" l2="4" h="10" color="gray"/>'
    foreign.write_text(
        '<aseba-playground><color name="gray" r="0.5" g="0.5" b="0.5"/><world w="100" h="100" color="gray"/>'
        f'{wall}<robot x="50" y="50"/></aseba-playground>'
    )
    open_page(page, world(foreign))
    wait_for_service(page, "/simulator/get_playground")
    open_tab(page, "playground")
    page.click("#playground-change")
    page.wait_for_function("window.thymio.built()?.playground.items.length >= 3")
    assert "box" in {item["kind"] for item in items(page).values()}


@pytest.mark.slow
def test_a_file_that_is_not_a_playground_is_rejected_in_plain_words(at_rest, page, tmp_path):
    letter = tmp_path / "letter.json"
    letter.write_text("hello")
    open_creator(page, at_rest)
    page.set_input_files("#creator-file", str(letter))
    fault = page.locator(".creator .fault")
    playwright.expect(fault).to_contain_text("This file is not a playground.")
    playwright.expect(fault.locator(".technical p")).to_be_hidden()
