"""The sensor panel in a real Chromium: values of a sensor that only its Python declaration describes."""

from __future__ import annotations

import os
import re

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests import plugin_page
from tests.web_ui.page_support import MARKS, choose_robot, open_details, open_page, open_tab

pytestmark = MARKS

MOTOR = "window.thymio.state().robot?.raw.motor"
HOLD_BEFORE_THE_PICTURE = """async () => {
    const [shown] = document.querySelectorAll(".motor .number");
    const isShown = () => shown.textContent === String(window.thymio.state().robot.raw.motor[0]);
    while (isShown()) await new Promise((end) => setTimeout(end));
    document.querySelector("[data-values=hold]").click();
    return document.querySelector(".picture svg").innerHTML;
}"""
"""Hold the values when others have been received, but are not yet in the picture; the picture."""
TIME = "window.thymio.state().timeNs"


def test_the_sensor_of_a_plug_in_is_shown_with_its_changing_value(suite, page, tmp_path, monkeypatch):
    plugin_page.lay_out(tmp_path, plugin_page.files())
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(tmp_path), os.environ.get("PYTHONPATH", ""))))
    open_page(page, suite("--playground", "slalom_field", "--program", "none"))
    open_details(page)
    row = page.get_by_role("row").filter(has=page.get_by_role("rowheader", name="heading", exact=True))
    values = row.get_by_role("cell")
    playwright.expect(page.get_by_role("rowheader", name="compass", exact=True)).to_be_visible()
    heading = re.compile(r"^-?\d °$")  # along the x axis, with noise
    playwright.expect(values.nth(0)).to_have_text(heading)
    playwright.expect(values.nth(1)).to_have_text(re.compile(r"^-?\d$"))
    first = values.nth(0).inner_text()
    playwright.expect(values.nth(0)).not_to_have_text(first)
    playwright.expect(values.nth(0)).to_have_text(heading)


@pytest.mark.slow
def test_values_are_subscribed_to_while_the_tab_is_open(at_rest, page):
    open_page(page, at_rest)
    open_tab(page, "robot")
    page.wait_for_function(f"{MOTOR} !== undefined")
    page.click("#work-fold")
    page.wait_for_function("() => !window.thymio.state().sensorsShown")
    before = page.evaluate(TIME)
    page.wait_for_function(f"(before) => {TIME} > before + 1e9", arg=before)
    page.evaluate("() => { window.words = window.thymio.state().robot.raw.motor; }")
    page.wait_for_function(f"(before) => {TIME} > before + 2e9", arg=before)
    assert page.evaluate(f"{MOTOR} === window.words"), "no message has arrived"
    open_tab(page, "robot")
    page.wait_for_function(f"{MOTOR} !== window.words")


@pytest.mark.slow
def test_the_picture_shows_what_the_robot_notices_and_does(world, page):
    open_page(page, world("base", behaviour="thesis_basic"))
    open_tab(page, "robot")
    picture = page.get_by_role("img", name="The robot from above")
    playwright.expect(picture.locator(".proximity")).to_have_count(7)
    speed = picture.locator(".motor .number")
    playwright.expect(speed.nth(0)).to_have_text("0")
    ground = page.locator(".ground-eye .num")
    playwright.expect(ground).to_have_text([re.compile(r"^\d+$")] * 2)
    playwright.expect(page.locator("[data-stat=tilt] b")).to_have_text(re.compile(r"^\d+ °$"))
    playwright.expect(page.locator("[data-stat=warmth] b")).to_have_text(re.compile(r"^\d\d °C$"))
    page.locator("[data-button=forward]").hover()
    page.mouse.down()
    playwright.expect(picture.locator("[data-button-mark=forward]")).to_have_attribute("data-pressed", "true")
    page.mouse.up()
    playwright.expect(picture.locator("[data-button-mark=forward]")).to_have_attribute("data-pressed", "false")
    # It drives to the wall, whose distance fills the bar in the middle, and stops there.
    playwright.expect(picture.locator("[data-index='2'] .number")).to_have_text(re.compile(r"^[1-9]\d{2,}$"))
    playwright.expect(picture.locator("[data-index='2'] .fill")).to_have_attribute("d", re.compile("^M"))
    playwright.expect(speed.nth(0)).to_have_text("0")


def test_held_values_stay_until_another_robot_is_chosen(world, page):
    open_page(page, world("two_robots", behaviour="explorer"))
    open_tab(page, "robot")
    number = page.locator(".motor .number").first
    playwright.expect(number).to_have_text(re.compile("^-?[1-9]"))
    hold = page.locator("[data-values=hold]")
    before = page.evaluate(HOLD_BEFORE_THE_PICTURE)
    playwright.expect(hold).to_have_text("Values are held")
    time = page.evaluate(TIME)
    page.wait_for_function(f"(time) => {TIME} > time + 1e9", arg=time)
    assert page.locator(".picture svg").inner_html() == before
    names = page.evaluate("() => Object.keys(window.thymio.state().robots)")
    choose_robot(page, names[1])
    playwright.expect(hold).to_have_text("Hold values")
