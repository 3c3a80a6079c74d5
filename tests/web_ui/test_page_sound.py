"""Sound in the browser after the first user action, and the choice of built-in behaviors."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, choose_example, choose_in_file_menu, open_page

pytestmark = MARKS

FAKE = (Path(__file__).parent / "audio.js").read_text().replace("export class", "class")
LISTEN = (
    FAKE
    + """
window.heard = [];
window.AudioContext = class extends FakeAudio { constructor() { super(); window.heard.push(this); } };
"""
)
OFFLINE = """
window.AudioContext = class extends OfflineAudioContext {
  constructor() { super(1, 22050, 22050); window.heard = this; }
  get state() { return "running"; }
  resume() { return Promise.resolve(); }
  suspend() { return Promise.resolve(); }
};
"""
LISTEN_A_SECOND = """async () => {
  const values = (await window.heard.startRendering()).getChannelData(0);
  const rising = values.reduce((count, value, at) => count + Number(at > 0 && values[at - 1] < 0 && value >= 0), 0);
  return {rising, loudest: Math.max(...values)};
}"""
SINGING = "call sound.freq(440, 0)\nonevent button.center\n  call sound.freq(550, -1)\n"
SOUNDING = "() => (window.heard[0]?.sounding ?? []).length"


def test_a_tone_is_played_after_the_first_user_action_and_until_it_is_muted(world, own_page, tmp_path):
    page = own_page
    program = tmp_path / "singing.aesl"
    program.write_text(SINGING)
    page.add_init_script(LISTEN)
    open_page(page, world("desk", program))
    page.wait_for_function("() => window.thymio.state().robot.sound[0] === 440")
    button = page.locator("button.sound")
    playwright.expect(button).to_have_attribute("data-phase", "waiting")
    assert page.evaluate("() => window.heard.length") == 0
    page.locator("#connection").click()
    page.wait_for_function(f"({SOUNDING})() === 1")
    source = "window.heard[0].sounding[0]"
    assert (
        page.evaluate(f"() => {source}.playbackRate.value * {source}.buffer.sampleRate / {source}.buffer.length") == 440
    )
    playwright.expect(button).to_have_attribute("data-phase", "on")  # what it does is what it shows
    button.click()
    page.wait_for_function(f"({SOUNDING})() === 0")
    playwright.expect(button).to_have_attribute("data-phase", "muted")
    button.click()
    page.wait_for_function(f"({SOUNDING})() === 1")
    page.locator("[data-button=center]").hover()
    page.mouse.down()
    page.wait_for_function(f"({SOUNDING})() === 0")
    page.mouse.up()


@pytest.mark.slow
def test_the_browser_plays_a_tone_of_that_pitch(world, own_page, tmp_path):
    page = own_page
    program = tmp_path / "singing.aesl"
    program.write_text(SINGING)
    page.add_init_script(OFFLINE)
    open_page(page, world("desk", program))
    page.wait_for_function("() => window.thymio.state().robot.sound[0] === 440")
    page.locator("#connection").click()
    page.wait_for_function("() => window.heard")
    heard = page.evaluate(LISTEN_A_SECOND)
    assert abs(heard["rising"] - 440) <= 1
    assert 0.05 < heard["loudest"] < 1


@pytest.mark.slow
def test_a_pause_suspends_the_sound(world, own_page, tmp_path):
    page = own_page
    program = tmp_path / "singing.aesl"
    program.write_text(SINGING)
    page.add_init_script(LISTEN)
    open_page(page, world("desk", program))
    page.locator("#connection").click()
    page.wait_for_function(f"({SOUNDING})() === 1")
    page.locator("#pause").click()
    page.wait_for_function("() => window.heard[0].state === 'suspended'")
    page.locator("#pause").click()
    page.wait_for_function("() => window.heard[0].state === 'running'")


@pytest.mark.slow
def test_a_built_in_behavior_is_chosen_and_shows_its_color(world, page):
    open_page(page, world("base", "welcome"))
    choose_example(page, "friendly")
    page.wait_for_function("() => window.thymio.state().program?.name.startsWith('friendly')")
    choose_in_file_menu(page, "examples")
    playwright.expect(page.locator("[data-example=friendly]")).to_have_attribute("aria-pressed", "true")
    swatch = page.locator("[data-example=friendly] .swatch")
    playwright.expect(swatch).to_have_attribute("style", re.compile("#12c22f"))
    # Green, as on the robot.
    page.wait_for_function(
        "() => { const [r, g, b] = window.thymio.state().robot.leds.top ?? []; return g > r && g > b; }"
    )
