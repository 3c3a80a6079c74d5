"""The view: saved images, 2D without WebGL, values at the beams, the robot's view, two robots."""

from __future__ import annotations

from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, choose_robot, open_menu, open_page, open_tab, wait_for_position
from tests.web_ui.test_welcome import visit

pytestmark = MARKS

NO_WEBGL = """
const real = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return kind.startsWith("webgl") ? null : real.call(this, kind, ...rest);
};
"""
LOSE = "() => document.querySelector('#view').getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()"
FLAT_COLORS = """() => {
  const canvas = document.querySelector('#flat');
  if (canvas.hidden) return 0;
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  return new Set(new Uint32Array(data.buffer)).size;
}"""
FLAT_WORLD_IS_FREE = """() => {
  const canvas = document.querySelector('#flat');
  const {data} = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const pixels = new Uint32Array(data.buffer);
  const box = {left: Infinity, right: -1, top: Infinity, bottom: -1};
  pixels.forEach((color, at) => {
    if (color === pixels[0]) return;
    const [x, y] = [at % canvas.width, Math.floor(at / canvas.width)];
    Object.assign(box, {left: Math.min(box.left, x), right: Math.max(box.right, x)});
    Object.assign(box, {top: Math.min(box.top, y), bottom: y});
  });
  const scene = canvas.getBoundingClientRect();
  const isWhole = box.left > 0 && box.top > 0 && box.right < canvas.width - 1 && box.bottom < canvas.height - 1;
  return isWhole && [...document.querySelectorAll('.views .float, #trouble, #tray, .welcome-start')].every((one) => {
    const {left, right, top, bottom, height} = one.getBoundingClientRect();
    return height === 0 || left > scene.left + box.right || right < scene.left + box.left
        || top > scene.top + box.bottom || bottom < scene.top + box.top;
  });
}"""
"""Whether the playground of the 2D view is whole and nothing is over it; the first pixel has the color of the desk."""
CANVAS = "() => document.querySelector('#view').width"
PNG = b"\x89PNG\r\n\x1a\n"


def test_without_webgl_the_world_is_drawn_in_2d_and_its_buttons_work(at_rest, own_page):
    page = own_page
    page.add_init_script(NO_WEBGL)
    open_page(page, at_rest)
    page.wait_for_function(f"({FLAT_COLORS})() > 4")
    playwright.expect(page.locator("#trouble")).to_contain_text("from above")
    page.locator("#view").focus()
    page.keyboard.press("f")
    place = wait_for_position(page, "button.center")
    page.mouse.move(place["x"], place["y"])
    page.mouse.down()
    page.wait_for_function("() => window.thymio.state().robot.buttons.center")
    page.mouse.up()
    with page.expect_download() as download:
        page.locator("[data-view=picture]").click()
    content = Path(download.value.path()).read_bytes()
    assert content.startswith(PNG)
    assert int.from_bytes(content[16:20]) >= 1920


@pytest.mark.slow
@pytest.mark.parametrize("size", [(1366, 768), (390, 844)])
def test_without_webgl_the_playground_is_whole_and_the_note_can_be_hidden(world, own_page, size):
    page = own_page
    page.set_viewport_size({"width": size[0], "height": size[1]})
    page.add_init_script(NO_WEBGL)
    address = world("line", "welcome")
    visit(page, address, "tour=off&welcome=on")
    page.locator(".welcome-starts").wait_for()
    page.wait_for_function(FLAT_WORLD_IS_FREE)
    page.keyboard.press("Escape")
    page.wait_for_function(FLAT_WORLD_IS_FREE)
    open_tab(page, "robot")
    page.wait_for_function(FLAT_WORLD_IS_FREE)
    height = "() => window.thymio.partPosition('robot').y"
    before = page.evaluate(height)
    page.locator("#trouble").get_by_role("button", name="Hide").click()
    playwright.expect(page.locator("#trouble")).to_be_hidden()
    page.wait_for_function(FLAT_WORLD_IS_FREE)
    page.wait_for_function(f"(before) => ({height})() > before", arg=before)  # it has the room now


@pytest.mark.slow
def test_a_context_that_is_not_restored_switches_to_2d(at_rest, own_page):
    page = own_page
    open_page(page, at_rest)
    wait_for_position(page, "robot")
    page.evaluate(LOSE)
    page.locator("#trouble").wait_for()
    page.wait_for_function(f"({FLAT_COLORS})() > 4")


def test_the_view_is_saved_as_an_image_and_the_robot_view_works(at_rest, page):
    page.set_viewport_size({"width": 888, "height": 700})  # the view is as wide as the window
    open_page(page, at_rest)
    wait_for_position(page, "robot")
    open_menu(page, "[data-view=look]")
    page.select_option("#quality", "simple")
    page.wait_for_function(f"({CANVAS})() < 500")
    coarse = page.evaluate(CANVAS)
    sizes = []
    for key in ("Home", "e"):
        page.locator("#view").focus()
        page.keyboard.press(key)
        with page.expect_download() as download:
            page.locator("[data-view=picture]").click()
        content = Path(download.value.path()).read_bytes()
        assert content.startswith(PNG)
        assert download.value.suggested_filename.startswith("base-")
        sizes.append(content)
    assert sizes[0] != sizes[1]
    assert all(int.from_bytes(content[16:20]) >= 1920 for content in sizes), "width in the PNG's header"
    assert page.evaluate("() => window.thymio.partPosition('robot')") is None  # it does not see itself
    assert page.evaluate(CANVAS) == coarse


@pytest.mark.slow
def test_two_robots_have_colors_and_the_selected_one_has_values_at_its_beams(world, page):
    open_page(page, world("two_robots"))
    page.wait_for_function("() => Object.keys(window.thymio.state().robots).length === 2")
    page.wait_for_function("() => document.querySelectorAll('#labels .dot').length === 2")
    open_menu(page, "#robot-chooser")
    names, choices = page.evaluate(
        "() => [[...document.querySelectorAll('#labels .dot')].map((one) => {"
        " one.style.outlineColor = one.style.getPropertyValue('--color');"
        " return getComputedStyle(one).outlineColor; }),"
        " [...document.querySelectorAll('#robot-menu .swatch')].map((one) => getComputedStyle(one).backgroundColor)]"
    )
    assert len(set(names)) == 2
    assert set(names) == set(choices)
    open_menu(page, "[data-view=look]")
    page.locator("#numbers").check()
    page.wait_for_function("() => document.querySelectorAll('.ray-number:not([hidden])').length === 9")
    choose_robot(page, "red")
    page.wait_for_function("() => window.thymio.state().selected === 'red'")
    names = page.locator("#labels .tag:not([hidden])")
    playwright.expect(names).to_have_text(["red"])
    page.locator("#labels .dot[data-robot=blue]").dispatch_event("click")
    page.wait_for_function("() => window.thymio.state().selected === 'blue'")
    playwright.expect(names).to_have_text(["blue"])


@pytest.mark.slow
def test_one_robot_needs_no_name(at_rest, page):
    open_page(page, at_rest)
    wait_for_position(page, "robot")
    assert page.locator("#labels .dot, #labels .tag").count() == 0
