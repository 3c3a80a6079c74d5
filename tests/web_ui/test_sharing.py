"""Programs and playgrounds in links: shared on one page, opened on another one beside what is there."""

from __future__ import annotations

import re

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    MARKS,
    choose_in_file_menu,
    open_editor,
    open_page,
    open_tab,
    without_welcome,
)
from tests.web_ui.test_page_access import AXE, findings

pytestmark = MARKS

NAME = '<img src=x onerror="document.title=1">'


def shared_link(page) -> str:
    """The link of the open program."""
    choose_in_file_menu(page, "share")
    page.locator(".sharing .sharing-qr").wait_for()
    link: str = page.locator(".sharing-link input").input_value()
    return link


def follow(page, link: str) -> None:
    """Open a page of the same suite with what a link shares, and wait for the dialog."""
    address, _, fragment = link.partition("#")
    page.goto(f"{without_welcome(address)}#{fragment}")
    page.locator("dialog.sharing").wait_for()


def test_a_program_in_a_link_is_opened_beside_the_own_one(at_rest, page, other_page) -> None:
    open_page(page, at_rest)
    open_editor(page)
    page.locator(".cm-content").fill("onevent prox\nmotor.left.target = 42")
    choose_in_file_menu(page, "share")
    page.locator("dialog.sharing").wait_for()
    page.keyboard.press("Escape")
    page.click("#file-menu")
    page.locator(".file-name").fill(f"{NAME}.aesl")
    page.locator(".file-name").press("Enter")
    link = shared_link(page)
    assert "target" not in link
    assert len(link) < 700
    page.get_by_text("holds the program itself").wait_for()
    page.get_by_text("This address works on this computer only.").wait_for()
    if AXE.exists():
        page.add_script_tag(path=str(AXE))
        assert findings(page) == []
    page.keyboard.press("Escape")

    open_page(other_page, at_rest)
    open_editor(other_page)
    other_page.locator(".cm-content").fill("var mine = 7")
    other_page.wait_for_function("() => Object.keys(localStorage).some((key) => key.startsWith('editor.draft'))")
    other_page.evaluate("(hash) => { location.hash = hash }", link.partition("#")[2])
    dialog = other_page.locator("dialog.sharing")
    dialog.get_by_text("You got a program").wait_for()
    assert dialog.locator("img").count() == 0  # names are text
    dialog.get_by_text("Program, Text, lines in the file:").wait_for()
    other_page.click("[data-share=open]")
    other_page.locator(".cm-content", has_text="motor.left.target = 42").wait_for()
    assert "share" not in other_page.url
    assert other_page.title() == "Thymio Sim"
    choose_in_file_menu(other_page, "new")
    other_page.locator("[data-recent]").first.click()
    other_page.locator(".cm-content", has_text="var mine = 7").wait_for()


@pytest.mark.parametrize(
    ("language", "sample", "shown"), [("vpl", "vpl-avoid", ".vpl-bar"), ("blocks", "blocks-line", ".blocklySvg")]
)
def test_a_program_of_another_language_comes_in_this_language(
    at_rest, page, other_page, language, sample, shown
) -> None:
    open_page(page, at_rest)
    open_tab(page, "program")
    page.click(f"[data-new={sample}]")
    page.locator(shown).first.wait_for()
    link = shared_link(page)
    follow(other_page, link)
    other_page.click("[data-share=open]")
    other_page.locator(shown).first.wait_for()
    pressed = other_page.locator(f"[data-language={language}]")
    assert pressed.get_attribute("aria-pressed") == "true"


def test_a_link_that_was_cut_says_so_and_can_be_pasted_again(at_rest, page, other_page) -> None:
    open_page(page, at_rest)
    open_editor(page)
    page.locator(".cm-content").fill("var whole = 1")
    link = shared_link(page)
    open_page(other_page, at_rest)
    open_editor(other_page)
    other_page.locator(".cm-content").fill("var mine = 7")
    other_page.evaluate("(hash) => { location.hash = hash }", link.partition("#")[2][:-20])
    trouble = other_page.locator("#sharing-trouble")
    trouble.wait_for()
    assert re.match(r"The link was cut: it has \d+ of \d+ characters\.", trouble.inner_text())
    assert "share" not in other_page.url
    other_page.fill("#sharing-paste", "https://example.org/")
    other_page.click("[data-share=paste]")
    other_page.locator("#sharing-trouble", has_text="This is no link with a program").wait_for()
    if AXE.exists():
        other_page.add_script_tag(path=str(AXE))
        assert findings(other_page) == []
    other_page.fill("#sharing-paste", f"Look at this: {link}")
    other_page.click("[data-share=paste]")
    other_page.click("[data-share=later]")
    other_page.locator(".cm-content", has_text="var mine = 7").wait_for()


def test_a_playground_in_a_link_becomes_an_own_one(at_rest, page, other_page) -> None:
    open_page(page, at_rest)
    open_tab(page, "playground")
    page.click("[data-share=playground]")
    link = page.locator(".sharing-link input").input_value()
    open_page(other_page, at_rest)
    open_tab(other_page, "playground")
    assert other_page.locator("[data-own]").count() == 0
    other_page.evaluate("(hash) => { location.hash = hash }", link.partition("#")[2])
    other_page.locator("dialog.sharing").get_by_text("You got a playground").wait_for()
    other_page.click("[data-share=open]")
    other_page.locator("[data-own]").wait_for()
    assert other_page.locator("[data-own]").count() == 1


def test_a_program_that_is_too_large_for_a_link_is_saved_to_a_file(at_rest, page) -> None:
    open_page(page, at_rest)
    open_editor(page)
    lines = "\n".join(f"# {'%x' % (7 ** (number + 300) % 16**120)}" for number in range(400))
    page.locator(".cm-content").fill(lines)
    choose_in_file_menu(page, "share")
    page.locator(".sharing", has_text="Too large for a link").wait_for()
    assert page.locator(".sharing-link").count() == 0
    with page.expect_download() as download:
        page.click("[data-share=save]")
    assert download.value.suggested_filename.endswith(".aesl")
