"""The playground creator in a real browser: what is built is kept, saved, opened, and tried."""

from __future__ import annotations

import json
import os

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests import plugin_page
from tests.web_ui.creator_support import (
    built,
    choose_more,
    click,
    items,
    open_creator,
    wait_for_camera,
    wait_for_items,
)
from tests.web_ui.page_support import (
    MARKS,
    choose_example,
    go_on_building,
    open_editor,
    open_page,
    open_tab,
)
from thymio_sim_ros.sim.playground import reader as playgrounds

pytestmark = MARKS

BASE = ("--playground", "base", "--program", "none")


def test_a_playground_is_built_with_undo_saved_restored_opened_and_tried(world, page, tmp_path):
    open_creator(page, world("base"))
    page.click("[data-tool=box]")
    click(page, 0.3, 0.3)
    click(page, 0.3, -0.3)
    wait_for_items(page, 4)
    page.keyboard.press("Control+z")
    wait_for_items(page, 3)
    page.keyboard.press("Control+z")
    page.keyboard.press("Control+y")
    page.keyboard.press("Control+Shift+Z")
    wait_for_items(page, 4)
    page.keyboard.press("Control+z")
    page.click("[data-tool=track]")
    for x, y in ((-0.4, -0.4), (0.4, -0.4), (0.4, 0.1)):
        click(page, x, y)
    page.click(".finish")
    wait_for_items(page, 4)
    assert items(page)["track_1"]["points_m"] == [[-0.4, -0.4], [0.4, -0.4], [0.4, 0.1]]
    page.keyboard.press("Escape")
    page.locator("[data-field=title]").fill("A way out")
    page.locator("[data-field=title]").press("Enter")
    with page.expect_download() as saving:
        choose_more(page, "save")
    assert saving.value.suggested_filename == "A_way_out.json"
    saved = tmp_path / "A_way_out.json"
    saving.value.save_as(saved)
    loaded = playgrounds.load(saved)
    assert [shape.name for shape in loaded.shapes] == ["ground", "box_1", "track_1"]

    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    go_on_building(page, "A way out")
    page.wait_for_function("window.thymio.built()?.playground.title === 'A way out'")
    choose_more(page, "new")
    wait_for_items(page, 2)
    page.set_input_files("#creator-file", str(saved))
    wait_for_items(page, 4)
    page.click("#creator-try")
    page.wait_for_function("window.thymio.state().simulator?.title === 'A way out'")
    page.wait_for_function("!window.thymio.built().isOpen")
    page.wait_for_function("window.thymio.state().robot?.latest")
    page.locator("#view").focus()
    page.keyboard.press("t")
    start = page.evaluate("window.thymio.state().robot.latest.pose")
    choose_example(page, "thesis_basic")
    page.wait_for_function(
        "window.thymio.state().program?.state === 'running' && window.thymio.state().program.name.includes('basic')"
    )
    page.locator("[data-button=forward]").hover()
    page.mouse.down()
    page.wait_for_function(
        "(start) => { const {x, y} = window.thymio.state().robot.latest.pose;"
        " return Math.hypot(x - start.x, y - start.y) > 0.03; }",
        arg=start,
    )


@pytest.mark.slow
def test_everything_is_built_by_keys_alone(world, page):
    open_page(page, world("base"))
    page.locator("#tab-playground").press("Enter")
    page.locator(".current [data-new]").press("Enter")
    page.locator("[data-tool=box]").press("Enter")
    assert page.evaluate("document.activeElement.id") == "view"
    for key in ("Shift+ArrowRight", "ArrowUp", ".", "Enter"):
        page.keyboard.press(key)
    page.keyboard.press("Escape")
    wait_for_items(page, 3)
    box = items(page)["box_1"]
    assert (box["x_m"], box["y_m"]) == (0.4, 0.05)
    assert box["yaw_rad"] == pytest.approx(-0.2618, abs=1e-3)
    page.locator("[data-tool=track]").press("Enter")
    for key in ("Shift+ArrowDown", " ", "Shift+ArrowRight", " ", "ArrowUp", " ", "Backspace", "Enter", "Escape"):
        page.keyboard.press(key)
    wait_for_items(page, 4)
    assert items(page)["track_1"]["points_m"] == [[0, -0.25], [0.25, -0.25]]
    page.keyboard.press("n")
    page.keyboard.press("n")
    assert built(page)["selected"] == "box_1"
    page.keyboard.press("Alt+ArrowLeft")
    assert items(page)["box_1"]["x_m"] == 0.399
    page.keyboard.press("Control+d")
    wait_for_items(page, 5)
    page.keyboard.press("Delete")
    wait_for_items(page, 4)
    page.keyboard.press("n")
    page.keyboard.press("n")
    page.keyboard.press("Enter")
    assert page.evaluate("document.activeElement.dataset.field") == "size_x_m"
    width = page.locator(".item-form [data-field=size_x_m]")
    width.fill("12.5")
    width.press("Enter")
    page.wait_for_function("window.thymio.built().playground.items.some(({size_x_m}) => size_x_m === 0.125)")
    page.locator("#view").focus()
    page.keyboard.press("Escape")
    assert built(page)["selected"] is None
    page.locator("#creator-try").press("Enter")
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")


@pytest.mark.slow
def test_a_playground_with_a_door_is_built_in_twelve_clicks_by_names_only(world, page):
    open_page(page, world("base"))
    page.get_by_role("tab", name="Playground").click()
    page.get_by_role("button", name="New playground").click()
    page.get_by_role("button", name="Door", exact=True).click()
    wait_for_camera(page)
    click(page, -0.2, 0.2)
    page.get_by_role("button", name="Plate", exact=True).click()
    click(page, 0.3, -0.2)
    wait_for_items(page, 4)
    page.get_by_role("button", name="Try it").click()  # the seventh click
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")
    page.wait_for_function("window.thymio.state().objects.length > 0")


@pytest.mark.slow
def test_an_image_is_placed_on_the_ground(world, page, tmp_path):
    drawing = tmp_path / "drawing.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 20 10"><circle r="5" cx="8" cy="5"/></svg>'
    )
    open_creator(page, world("base"))
    page.set_input_files("#creator-picture", str(drawing))
    page.wait_for_function("window.thymio.built().placing?.kind === 'picture'")
    click(page, 0.2, 0.2)
    wait_for_items(page, 3)
    page.click("#creator-try")
    page.wait_for_function("window.thymio.state().simulator.playground === 'My_playground.json'")


@pytest.mark.slow
def test_a_shape_of_a_plugin_is_placed_edited_saved_and_drawn_as_the_simulator_has_it(
    suite, page, tmp_path, monkeypatch
):
    installed = tmp_path / "site-packages"
    plugin_page.lay_out(installed, plugin_page.files())
    monkeypatch.setenv("PYTHONPATH", f"{installed}{os.pathsep}{os.environ.get('PYTHONPATH', '')}")
    open_creator(page, suite(*BASE))
    tool = page.locator("[data-tool=slalom]")
    assert tool.get_attribute("title") == "Slalom posts"
    tool.click()
    click(page, -0.4, 0.3)
    wait_for_items(page, 3)
    page.keyboard.press("Escape")
    click(page, -0.4, 0.3, 0.05)
    page.locator("[data-field=gap_m]").fill("50")
    page.locator("[data-field=gap_m]").press("Enter")
    page.wait_for_function("() => window.thymio.built().drawn.filter((key) => key.includes('slalom_1')).length === 3")
    page.locator("[data-field=length_m]").fill("5")
    page.locator("[data-field=length_m]").press("Enter")
    page.wait_for_function("() => window.thymio.built().drawn.filter((key) => key.includes('slalom_1')).length === 1")
    page.click("[data-verb=undo]")
    assert page.locator(".field", has=page.locator("[data-field=gap_m]")).locator("label").text_content() == "Gap (cm)"
    page.locator("[data-field=gap_m]").fill("0")
    page.locator("[data-field=gap_m]").press("Enter")
    page.locator("[data-field=gap_m][aria-invalid=true]").wait_for()
    with page.expect_download() as saving:
        choose_more(page, "save")
    saved = json.loads(saving.value.path().read_text())
    assert saved["shapes"][1] == {
        "kind": "slalom", "name": "slalom_1", "x_m": -0.4, "y_m": 0.3, "length_m": 1, "gap_m": 0.5,
    }  # fmt: skip
    page.click("#creator-try")
    page.locator(".palette").wait_for(state="detached")
    page.wait_for_function("() => window.thymio.state().markers > 4")


@pytest.mark.slow
def test_the_head_says_where_the_playground_is_kept(at_rest, page):
    open_creator(page, at_rest)
    kept = page.locator(".creator .kept")
    playwright.expect(kept).to_have_text("Nothing to save yet")
    page.locator("[data-field=title]").fill("Kept")
    page.locator("[data-field=title]").press("Enter")
    playwright.expect(kept).to_have_text("Saved on this device")
    open_editor(page)
    page.focus(".cm-content")
    page.keyboard.insert_text("var a")
    playwright.expect(page.locator(".program-unsaved")).to_be_visible()
    open_tab(page, "playground")
    playwright.expect(kept).to_have_text("Saved on this device")
    with page.expect_download():
        choose_more(page, "save")
    playwright.expect(kept).to_have_text("Saved as a file")
    page.reload()
    page.wait_for_function("window.thymio && window.thymio.connected")
    go_on_building(page, "Kept")
    page.wait_for_function("window.thymio.built()?.playground.title === 'Kept'")
    playwright.expect(kept).to_have_text("Saved as a file")


@pytest.mark.slow
def test_another_tab_shows_the_running_world_and_the_tab_of_playgrounds_continues(at_rest, page):
    open_creator(page, at_rest)
    open_editor(page)
    assert built(page)["isOpen"] is False
    open_tab(page, "playground")
    page.locator(".palette").wait_for()
    playwright.expect(page.locator(".editor")).to_be_hidden()


@pytest.mark.slow
def test_without_ground_the_creator_warns_and_offers_to_add_one(at_rest, page):
    open_creator(page, at_rest)
    add = page.get_by_role("button", name="Add a ground")
    playwright.expect(add).to_be_hidden()
    page.select_option("#creator-ground", "none")
    add.click()
    playwright.expect(add).to_be_hidden()
    page.wait_for_function("window.thymio.built().playground.items[0].kind === 'rectangle'")
