"""The page in a real Chromium with a running suite: drawing, driving, buttons, programs, playgrounds."""

from __future__ import annotations

import gzip
import json
import zipfile
from pathlib import Path

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.sim.images import BLACK, WHITE, png
from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_playground,
    drop_file,
    open_editor,
    open_hands,
    open_page,
    open_tab,
    wait_for_frame,
    wait_for_position,
    wait_for_program,
)

pytestmark = MARKS

MOST_BYTES = 300_000  # compressed, docs/performance.md, "The page"

PROGRAM = """\
var lit = 0
onevent button.center
if button.center == 1 then
    lit = 1 - lit
    call leds.top(0, 32 * lit, 0)
    motor.left.target = 150 * lit
    motor.right.target = 150 * lit
end
"""

POSE = "window.thymio.state().robot.latest.pose"


def robot(page):
    return page.evaluate("window.thymio.partPosition('robot')")


def colors(page) -> int:
    """Number of different colors in a screenshot of the canvas."""
    image = page.locator("canvas:visible").first.screenshot()  # without WebGL, that of the flat view
    return page.evaluate(
        """async (bytes) => {
            const bitmap = await createImageBitmap(new Blob([new Uint8Array(bytes)], {type: 'image/png'}));
            const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
            const context = canvas.getContext('2d');
            context.drawImage(bitmap, 0, 0);
            const data = new Uint32Array(context.getImageData(0, 0, bitmap.width, bitmap.height).data.buffer);
            return new Set(data).size;
        }""",
        list(image),
    )


def test_the_canvas_shows_something_and_the_robot_moves(world, page):
    open_page(page, world("desk", "line_follower"))
    page.wait_for_function("window.thymio.frames() > 2 && window.thymio.state().markers > 0")
    wait_for_frame(page)
    assert colors(page) > 20
    begin = robot(page)
    page.wait_for_function(
        "(begin) => { const now = window.thymio.partPosition('robot');"
        " return Math.hypot(now.x - begin.x, now.y - begin.y) > 5; }",
        arg=begin,
    )


@pytest.mark.slow
def test_little_is_loaded_before_the_editor_is_opened(at_rest, own_page):
    page = own_page
    loaded: dict[str, bytes] = {}
    page.on("requestfinished", lambda request: loaded.update({request.url: request.response().body()}))
    open_page(page, at_rest)
    page.wait_for_function("() => window.thymio.state().markers > 0")
    assert len(loaded) <= 12  # some of them are what it shares with the teacher's page of a class
    assert sum(len(gzip.compress(body)) for body in loaded.values()) < MOST_BYTES
    assert [url for url in loaded if "editor" in url] == []


def test_a_click_on_the_center_button_reaches_the_program(world, page, tmp_path):
    program = tmp_path / "switch.aesl"
    program.write_text(PROGRAM)
    open_page(page, world("base", program))
    wait_for_program(page, "switch.aesl")
    wait_for_position(page, "robot")
    begin = robot(page)
    press(page, "button.center")
    page.wait_for_function(
        "(begin) => { const now = window.thymio.partPosition('robot');"
        " return Math.hypot(now.x - begin.x, now.y - begin.y) > 5; }",
        arg=begin,
    )


@pytest.mark.slow
def test_with_shift_a_mouse_keeps_several_buttons_pressed(at_rest, page):
    open_page(page, at_rest)
    page.locator("#view").focus()
    page.keyboard.press("f")
    place = wait_for_position(page, "button.forward")
    start = page.evaluate(POSE)
    pressed = "() => Object.entries(window.thymio.state().robot.buttons).filter(([, is]) => is).map(([name]) => name)"
    page.keyboard.down("Shift")
    page.mouse.click(place["x"], place["y"])
    page.click("[data-button=left]")
    page.click("[data-button=center]")
    page.wait_for_function(f"() => ({pressed})().sort().join() === 'center,forward,left'")
    page.keyboard.up("Shift")
    page.wait_for_function(f"() => ({pressed})().length === 0")
    page.mouse.move(place["x"], place["y"])
    page.mouse.down()
    page.wait_for_function(f"() => ({pressed})().join() === 'forward'")
    page.mouse.up()
    page.wait_for_function(f"() => ({pressed})().length === 0")
    assert page.evaluate(POSE) == start, "a button that is held is not carried"


SENSES = """\
timer.period[0] = 20
onevent tap
call leds.top(32, 0, 0)
onevent rc5
if rc5.command == 87 then call leds.circle(32, 0, 0, 0, 0, 0, 0, 0) end
onevent temperature
if temperature > 300 then call leds.bottom.left(0, 32, 0) end
onevent timer0
if acc[0] < -10 then call leds.bottom.right(0, 0, 32) end
"""


def test_stimuli_reach_the_program(world, page, tmp_path):
    program = tmp_path / "senses.aesl"
    program.write_text(SENSES)
    open_page(page, world("base", program))
    wait_for_program(page, "senses.aesl")
    page.wait_for_function("() => window.thymio.state().robot.leds.top !== undefined")
    for control, group in (
        ("tap", "top"),
        ("remote", "circle"),
        ("temperature", "bottom_left"),
        ("roll", "bottom_right"),
    ):
        assert max(page.evaluate("(group) => window.thymio.state().robot.leds[group]", group)) == 0
        if control == "tap":
            page.click("[data-operate=tap]")
        elif control == "remote":
            open_hands(page, "remote")
            page.click("[data-key='87']")
        else:
            open_hands(page, "tilt" if control == "roll" else "room")
            page.locator(f"[data-operate={control}]").fill("45")
        page.wait_for_function("(group) => Math.max(...window.thymio.state().robot.leds[group]) === 1", arg=group)


@pytest.mark.slow
def test_the_pen_leaves_a_trail(world, page):
    open_page(page, world("desk", "line_follower"))
    open_hands(page, "pen")
    page.click("[data-pen=down]")
    page.wait_for_function("() => window.thymio.state().robot.trail > 0")


def press(page, part):
    """Press a part of the model by pointer, once the view is still, until the page has received the change."""
    position = wait_for_position(page, part)
    page.mouse.move(position["x"], position["y"])
    page.mouse.down()
    page.wait_for_function("() => window.thymio.state().robot.buttons.center === true")
    page.mouse.up()
    page.wait_for_function("() => window.thymio.state().robot.buttons.center === false")


def test_an_error_is_shown_at_its_position_and_the_previous_program_keeps_running(world, page, tmp_path):
    open_page(page, world("desk", "line_follower"))
    broken = tmp_path / "broken.aesl"
    broken.write_text("var a\nonevent prox\n  motor.left.targt = 5\n")
    wait_for_program(page, "line_follower.aesl")
    drop_file(page, broken, "#view")
    page.locator(".notice", has_text="motor.left.target").wait_for()
    playwright.expect(page.locator("body")).to_contain_text("line 3", ignore_case=True, use_inner_text=True)
    assert Path(page.evaluate("window.thymio.state().program.name")).name == "line_follower.aesl"
    open_tab(page, "program")  # there the mistake is explained at its place
    playwright.expect(page.locator(".mistake-card")).to_contain_text("motor.left.target")
    playwright.expect(page.locator("#program-state")).to_have_text("Robot runs Follow the line")


AT_CENTER_OF = """(message, selector) => {
    const {left, top, width, height} = document.querySelector(selector).getBoundingClientRect();
    const [x, y] = [left + width / 2, top + height / 2];
    const box = message.getBoundingClientRect();
    const away = [x - Math.max(box.left, Math.min(x, box.right)), y - Math.max(box.top, Math.min(y, box.bottom))];
    return Math.hypot(...away) < 20;
}"""


@pytest.mark.slow
def test_a_rejection_is_shown_where_the_file_was_dropped_or_chosen(at_rest, page, tmp_path):
    playground, program, unknown = tmp_path / "bad.json", tmp_path / "bad.aesl", tmp_path / "bad.dat"
    playground.write_text('{"format": 1}')
    program.write_text('<network>\n<node nodeId="1" name="thymio-II">var a = = 1</node></network>')
    unknown.write_text("")
    open_page(page, at_rest)
    notices = page.locator(".notice:visible")
    here = page.locator(".message-at:visible")
    open_editor(page)
    for file in (playground, unknown):
        drop_file(page, file, "#view")
        playwright.expect(here).to_contain_text(file.name)
        assert here.evaluate(AT_CENTER_OF, "#view")
        here.get_by_role("button").click()
        playwright.expect(here).to_be_hidden()
    build_playground(page)
    drop_file(page, program, "#view")
    playwright.expect(notices.filter(has_text="bad.aesl")).to_have_count(1)
    drop_file(page, playground, "#view")
    playwright.expect(here).to_contain_text("bad.json")
    page.click(".creator .leave")
    page.set_input_files("#playground-file", str(playground))
    playwright.expect(page.locator(".current .fault:visible")).to_contain_text("bad.json")
    playwright.expect(here).to_be_hidden()


@pytest.mark.slow
def test_another_playground_can_be_chosen(world, page):
    open_page(page, world("desk", "welcome"))
    choose_playground(page, "obstacle")
    page.wait_for_function("window.thymio.state().simulator.playground === 'obstacle'")


def test_an_aseba_playground_is_opened_with_warnings_and_a_broken_one_is_rejected(world, page, tmp_path):
    colors = '<color name="white" r="1" g="1" b="1"/>'
    content = '<world w="100" h="100" color="white" groundTexture="ground.png"/><robot x="50" y="50"/><feeder/>'
    archive = tmp_path / "my maze.playground"
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("world.xml", f"<aseba-playground>{colors}{content}</aseba-playground>")
        packed.writestr("ground.png", png([[BLACK, WHITE]]))
    broken = tmp_path / "broken.playground"
    broken.write_text("<aseba-playground>\n<world w='wide'/></aseba-playground>")
    open_page(page, world("base", "welcome"))
    open_tab(page, "playground")
    page.set_input_files("#playground-file", str(archive))
    page.wait_for_function("window.thymio.state().simulator.playground === 'my maze.playground'")
    playwright.expect(page.locator("details.remarks")).to_contain_text("<feeder> skipped")
    page.set_input_files("#playground-file", str(broken))
    fault = page.locator("div.fault", has_text="broken.playground")
    playwright.expect(fault.locator(".reason")).to_have_text("Line 2: One of its values must be a number.")
    technical = fault.locator(".technical p")
    playwright.expect(technical).to_be_hidden()
    playwright.expect(technical).to_have_text("line 2: <world> w: found 'wide', expected a number")
    assert page.evaluate("window.thymio.state().simulator.playground") == "my maze.playground"


@pytest.mark.slow
def test_a_pushed_object_moves_on_the_page(world, page, tmp_path):
    can = {"kind": "cylinder", "name": "can", "x_m": 0.2, "y_m": 0, "radius_m": 0.03, "height_m": 0.1, "mass_kg": 0.05}
    ground = {"kind": "rectangle", "size_x_m": 3, "size_y_m": 1, "color": "#ffffff"}
    shapes = [ground, can | {"color": "#cc3333"}]
    robots = [{"name": "thymio", "x_m": 0, "y_m": 0}]
    playground, program = tmp_path / "push.json", tmp_path / "push.aesl"
    playground.write_text(json.dumps({"format": 1, "title": "Push", "shapes": shapes, "robots": robots}))
    program.write_text("motor.left.target = 200\nmotor.right.target = 200")
    open_page(page, world(playground, program))
    page.wait_for_function("() => window.thymio.state().objects.some((thing) => thing.pose.position.x > 0.3)")
    assert page.evaluate("() => window.thymio.state().objects.map((thing) => thing.name)") == ["can"]
