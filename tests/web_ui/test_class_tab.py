"""The tab Class with twenty robots: one word for each, who needs a look first, programs for all, names."""

from __future__ import annotations

from typing import Any

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import KEY_MS, MARKS, choose_language, choose_robot, drop_file, open_page, open_tab
from tests.web_ui.test_page_access import AXE, FINDINGS

pytestmark = MARKS

RUN = """(name) => Object.values(window.thymio.state().programs).filter(
    (program) => program.state === "running" && program.name.startsWith(name)).length === 20"""
FAULTY = "var list[3]\nvar at = 7\nlist[at] = 1\n"


@pytest.fixture
def class_page(world, page, class_world) -> Any:
    """Twenty robots that wait, and the tab with them."""

    page.set_viewport_size({"width": 1280, "height": 800})
    open_page(page, world(class_world, "welcome"))
    page.wait_for_function(RUN, arg="welcome")
    open_tab(page, "class")
    page.locator(".class-tile").nth(19).wait_for()
    return page


def count(page, name):
    return page.locator(f"[data-filter={name}] .num")


def test_a_program_for_all_and_one_pupil_in_trouble(class_page, tmp_path):
    page = class_page
    playwright.expect(count(page, "all")).to_have_text("20")
    playwright.expect(count(page, "idle")).to_have_text("20")  # they wait with their light
    page.click("[data-class=give]")
    page.click("[data-give=explorer]")
    page.wait_for_function(RUN, arg="explorer")
    playwright.expect(page.locator("#robot-chooser")).to_contain_text("All 20 robots")
    playwright.expect(page.locator(".class-state[data-state=runs]")).to_have_count(20)
    playwright.expect(count(page, "idle")).to_have_text("0")

    tile = page.locator(".class-tile[data-robot=thymio_7]")
    tile.click()
    playwright.expect(tile).to_have_attribute("aria-pressed", "true")
    program = tmp_path / "faulty.aesl"
    program.write_text(FAULTY)
    drop_file(page, program, "#view")
    playwright.expect(tile).to_contain_text("mistake")
    playwright.expect(count(page, "look")).to_have_text("1")
    trouble = page.locator(".class-trouble")
    playwright.expect(trouble).to_contain_text("thymio_7 has a mistake in line 3")
    playwright.expect(trouble).to_contain_text("Only just now.")
    page.click("[data-filter=look]")
    playwright.expect(page.locator(".class-tile")).to_have_count(1)

    page.locator(".class-tile").click()
    choose_robot(page, "thymio_2")
    page.click("[data-class=go]")
    playwright.expect(page.locator("#robot-chooser")).to_contain_text("thymio_7")
    playwright.expect(page.locator("[data-view=follow]")).to_have_attribute("aria-pressed", "true")
    page.click("[data-class=program]")
    playwright.expect(page.locator(".cm-content")).to_contain_text("list[at] = 1")

    open_tab(page, "class")
    page.click("[data-class=stop]")
    page.wait_for_function("() => window.thymio.state().programs.thymio_1.state === 'stopped'")
    page.click("[data-filter=all]")
    playwright.expect(page.locator(".class-state[data-state=stopped]")).to_have_count(20)
    before = page.evaluate("window.thymio.state().timeNs")
    page.click("[data-class=start]")
    page.wait_for_function("(before) => window.thymio.state().timeNs < before", arg=before)


@pytest.mark.slow
def test_names_are_given_by_keys_shown_everywhere_and_kept(class_page):
    page = class_page
    page.click("[data-names=edit]")
    fields = page.locator(".class-field")
    playwright.expect(fields).to_have_count(20)
    fields.first.focus()
    for name in ("Ada", "Ben"):
        page.keyboard.type(name, delay=KEY_MS)
        page.keyboard.press("Enter")
    page.click("[data-names=edit]")
    playwright.expect(page.locator(".class-name").first).to_have_text("Ada")
    page.locator(".class-tile").nth(1).click()
    playwright.expect(page.locator("#robot-chooser")).to_contain_text("Ben")
    page.reload()
    page.locator(".class-tile").nth(19).wait_for()  # the tab, too, is remembered
    playwright.expect(page.locator(".class-name").nth(1)).to_have_text("Ben")


@pytest.mark.slow
def test_it_is_accessible_in_both_themes_and_every_language(class_page):
    page = class_page
    page.emulate_media(reduced_motion="reduce")
    for language in ("de", "fr", "it", "en"):
        choose_language(page, language)
        page.locator(".class-tile").nth(19).wait_for()
        page.wait_for_function("() => document.querySelector('#panel-class').scrollWidth <= 576")
        for button in page.locator(".class-row button").all():
            assert button.evaluate("(button) => button.scrollWidth <= button.clientWidth + 1")
    if not AXE.exists():
        pytest.skip("axe is not installed")
    page.add_script_tag(path=str(AXE))
    for theme in ("light", "dark"):
        page.emulate_media(color_scheme=theme)
        assert page.evaluate(FINDINGS) == []


@pytest.mark.slow
def test_one_robot_is_no_class(at_rest, page):
    open_page(page, at_rest)
    playwright.expect(page.locator("#tab-robot")).to_be_visible()
    playwright.expect(page.locator("#tab-class")).to_be_hidden()
