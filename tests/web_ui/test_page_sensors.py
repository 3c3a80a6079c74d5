"""The sensor panel in a real Chromium: values of a sensor that only its Python declaration describes."""

from __future__ import annotations

import os
import re

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests import plugin_page
from tests.web_ui.page_support import MARKS, open_page, open_tab

pytestmark = MARKS

MOTOR = "window.thymio.state().robot?.raw.motor"
TIME = "window.thymio.state().timeNs"


def test_the_sensor_of_a_plug_in_is_shown_with_its_changing_value(suite, page, tmp_path, monkeypatch):
    plugin_page.lay_out(tmp_path, plugin_page.files())
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join((str(tmp_path), os.environ.get("PYTHONPATH", ""))))
    open_page(page, suite("--playground", "slalom_field", "--program", "none"))
    open_tab(page, "robot")
    row = page.get_by_role("row").filter(has=page.get_by_role("rowheader", name="heading", exact=True))
    values = row.get_by_role("cell")
    playwright.expect(page.get_by_role("rowheader", name="compass", exact=True)).to_be_visible()
    heading = re.compile(r"^-?\d °$")  # along the x axis, with noise
    playwright.expect(values.nth(0)).to_have_text(heading)
    playwright.expect(values.nth(1)).to_have_text(re.compile(r"^-?\d$"))
    first = values.nth(0).inner_text()
    playwright.expect(values.nth(0)).not_to_have_text(first)
    playwright.expect(values.nth(0)).to_have_text(heading)


def test_values_are_subscribed_to_while_the_panel_is_open(suite, page):
    open_page(page, suite("--playground", "base", "--program", "none"))
    open_tab(page, "robot")
    page.wait_for_function(f"{MOTOR} !== undefined")
    page.click("#values summary")
    page.wait_for_function("() => !window.thymio.state().sensorsShown")
    before = page.evaluate(TIME)
    page.wait_for_function(f"(before) => {TIME} > before + 1e9", arg=before)
    page.evaluate("() => { window.words = window.thymio.state().robot.raw.motor; }")
    page.wait_for_function(f"(before) => {TIME} > before + 2e9", arg=before)
    assert page.evaluate(f"{MOTOR} === window.words"), "no message has arrived"
    page.click("#values summary")
    page.wait_for_function(f"{MOTOR} !== window.words")
